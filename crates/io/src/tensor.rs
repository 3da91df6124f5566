//! Tensor files, as measured materials come in them (Dupuy and Jakob 2018; <https://rgl.epfl.ch/materials>): named arrays of
//! numbers of any shape, with where each lies in the file.
//!
//! `tensor_file`, a zero byte, version 1.0, the number of fields; of each its name, axes, type, place and size along each axis.
//! The format is described by its readers, those of Mitsuba and pbrt-v4.
use std::{collections::BTreeMap, sync::Arc};

use durer_scene::{AssetError, Tensor, TensorType, Tensors};

/// The first twelve bytes.
const MAGIC: &[u8] = b"tensor_file\0";
/// Most fields of a file, and most axes of one.
const MOST_FIELDS: u32 = 1000;
const MOST_AXES: u16 = 16;

/// Where reading is in a file.
struct Bytes<'a> {
    left: &'a [u8],
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (taken, left) =
            self.left.split_at_checked(count).ok_or("the file ends before all its fields are told")?;
        self.left = left;
        Ok(taken)
    }
    fn number<const N: usize>(&mut self) -> Result<u64, String> {
        Ok(self.take(N)?.iter().rev().fold(0, |all, byte| all << 8 | u64::from(*byte)))
    }
}

/// The type of this number.
fn ty(number: u64) -> Option<TensorType> {
    Some(match number {
        1 => TensorType::U8,
        2 => TensorType::Other(1),
        3 | 4 | 9 => TensorType::Other(2),
        5 | 6 => TensorType::Other(4),
        7 | 8 | 11 => TensorType::Other(8),
        10 => TensorType::F32,
        _ => return None,
    })
}

/// What is in a file.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn read(file: Arc<[u8]>, path: &str) -> Result<Tensors, AssetError> {
    let fields = fields(&file).map_err(|reason| AssetError::Format { path: path.to_owned(), reason })?;
    let outside = || AssetError::Format {
        path: path.to_owned(),
        reason: "a field is not as long as its shape says".to_owned(),
    };
    Tensors::new(file, fields).ok_or_else(outside)
}

fn fields(file: &[u8]) -> Result<BTreeMap<String, Tensor>, String> {
    let Some(left) = file.strip_prefix(MAGIC) else {
        return Err("not a tensor file: it does not begin as one does".to_owned());
    };
    let mut bytes = Bytes { left };
    let (major, minor) = (bytes.number::<1>()?, bytes.number::<1>()?);
    if (major, minor) != (1, 0) {
        return Err(format!("a tensor file of version {major}.{minor}, expected 1.0"));
    }
    let count = bytes.number::<4>()?;
    if count > u64::from(MOST_FIELDS) {
        return Err(format!("the file claims to hold {count} fields, expected at most {MOST_FIELDS}"));
    }
    let mut all = BTreeMap::new();
    for _ in 0..count {
        let length = bytes.number::<2>()? as usize;
        let name = String::from_utf8_lossy(bytes.take(length)?).into_owned();
        let (axes, number) = (bytes.number::<2>()?, bytes.number::<1>()?);
        if axes > u64::from(MOST_AXES) {
            return Err(format!("\"{name}\" claims to have {axes} axes, expected at most {MOST_AXES}"));
        }
        let ty =
            ty(number).ok_or_else(|| format!("\"{name}\" holds numbers of an unknown type ({number})"))?;
        let start = bytes.number::<8>()?;
        let shape = (0..axes).map(|_| bytes.number::<8>()).collect::<Result<Vec<u64>, String>>()?;
        let place = || {
            let shape: Vec<usize> = shape.iter().map(|n| usize::try_from(*n).ok()).collect::<Option<_>>()?;
            let length = shape.iter().try_fold(ty.bytes(), |all, n| all.checked_mul(*n))?;
            let start = usize::try_from(start).ok()?;
            let end = start.checked_add(length).filter(|end| *end <= file.len())?;
            Some(Tensor { ty, shape, place: start..end })
        };
        let tensor = place().ok_or_else(|| {
            format!(
                "\"{name}\", {shape:?} at byte {start}, does not lie in the file, of {} bytes",
                file.len()
            )
        })?;
        if all.insert(name.clone(), tensor).is_some() {
            return Err(format!("there are two fields called \"{name}\""));
        }
    }
    Ok(all)
}
