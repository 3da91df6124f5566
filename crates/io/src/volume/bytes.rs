//! Numbers and texts of a binary file, one after another.

/// Why a file is not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Why {
    /// It is not what it claims to be.
    Damaged(String),
    /// It is fine, but not of what we read.
    Refused(String),
    /// It takes too much memory.
    TooLarge(String),
}

/// Where reading is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bytes<'a> {
    data: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    pub(super) fn new(data: &'a [u8]) -> Self {
        Self { data, at: 0 }
    }
    /// Bytes of the file.
    pub(super) fn length(&self) -> usize {
        self.data.len()
    }
    pub(super) fn take(&mut self, count: usize) -> Result<&'a [u8], Why> {
        let end = self.at.checked_add(count);
        let found = end.and_then(|end| self.data.get(self.at..end));
        let Some(found) = found else {
            return Err(Why::Damaged(format!(
                "the file ends at byte {}, expected {count} more at byte {}",
                self.data.len(),
                self.at
            )));
        };
        self.at += count;
        Ok(found)
    }
    pub(super) fn skip(&mut self, count: usize) -> Result<(), Why> {
        self.take(count).map(|_| ())
    }
    /// Goes on at this byte of the file, further on.
    pub(super) fn jump(&mut self, to: u64) -> Result<(), Why> {
        let to = usize::try_from(to).ok().filter(|to| *to >= self.at && *to <= self.data.len());
        self.at = to.ok_or_else(|| Why::Damaged("a grid lies outside the file".to_owned()))?;
        Ok(())
    }
    fn array<const N: usize>(&mut self) -> Result<[u8; N], Why> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }
    pub(super) fn u8(&mut self) -> Result<u8, Why> {
        self.array().map(|[byte]| byte)
    }
    pub(super) fn u32(&mut self) -> Result<u32, Why> {
        self.array().map(u32::from_le_bytes)
    }
    pub(super) fn i32(&mut self) -> Result<i32, Why> {
        self.array().map(i32::from_le_bytes)
    }
    pub(super) fn i64(&mut self) -> Result<i64, Why> {
        self.array().map(i64::from_le_bytes)
    }
    pub(super) fn f32(&mut self) -> Result<f32, Why> {
        self.array().map(f32::from_le_bytes)
    }
    pub(super) fn f64(&mut self) -> Result<f64, Why> {
        self.array().map(f64::from_le_bytes)
    }
    pub(super) fn triple(&mut self) -> Result<[f64; 3], Why> {
        Ok([self.f64()?, self.f64()?, self.f64()?])
    }
    pub(super) fn index(&mut self) -> Result<[i32; 3], Why> {
        Ok([self.i32()?, self.i32()?, self.i32()?])
    }
    /// A text with its length before it.
    pub(super) fn text(&mut self) -> Result<String, Why> {
        let length = self.u32()? as usize;
        self.take(length).map(|text| String::from_utf8_lossy(text).into_owned())
    }
}

/// A bit for each value of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mask<'a>(&'a [u8]);

impl<'a> Mask<'a> {
    /// Reads that of this many values.
    pub(super) fn read(bytes: &mut Bytes<'a>, count: usize) -> Result<Self, Why> {
        bytes.take(count / 8).map(Self)
    }
    pub(super) fn is_on(self, index: usize) -> bool {
        self.0.get(index / 8).is_some_and(|byte| byte >> (index % 8) & 1 == 1)
    }
    pub(super) fn count(self) -> usize {
        self.0.iter().map(|byte| byte.count_ones() as usize).sum()
    }
}
