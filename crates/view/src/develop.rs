//! Pictures of light that the viewer compares with: developed as his own picture is, since browsers read no OpenEXR.
use std::time::Duration;

use durer::{
    film::{ToneMap, develop},
    image::{Packing, encode_png, read},
    scene::{Image, ImageData, Limits},
};
use http_body_util::{BodyExt, Limited};
use hyper::body::{Bytes, Incoming};
use tokio::sync::Semaphore;

/// Most bytes of a picture's file.
const MOST_BYTES: usize = 256 << 20;
/// Most pixels of a picture.
const MOST_PIXELS: u64 = 1 << 25;
/// How long it may take to come in.
const PATIENCE: Duration = Duration::from_secs(60);

/// The picture as a PNG; `room` is for one at a time, as each takes as much memory as the limits allow.
///
/// # Errors
/// Why there is none.
pub(crate) async fn developed(
    body: Incoming,
    (exposure, tonemap): (f32, ToneMap),
    room: &Semaphore,
) -> Result<Vec<u8>, String> {
    let _place = room.acquire().await.map_err(|e| e.to_string())?;
    let whole = tokio::time::timeout(PATIENCE, Limited::new(body, MOST_BYTES).collect()).await;
    let bytes = match whole {
        Ok(Ok(body)) => body.to_bytes(),
        Ok(Err(_)) => return Err(format!("the file is cut off, or has more than {} MiB", MOST_BYTES >> 20)),
        Err(_) => return Err("the file takes too long to come".to_owned()),
    };
    // The other pages go on meanwhile.
    let work = tokio::task::spawn_blocking(move || picture(&bytes, exposure, tonemap));
    work.await.map_err(|_| "durer failed at this file: please report it".to_owned())?
}

fn picture(bytes: &Bytes, exposure: f32, tonemap: ToneMap) -> Result<Vec<u8>, String> {
    let limits = Limits { image_pixels: MOST_PIXELS, ..Limits::default() };
    let image = read(bytes, "the picture", limits).map_err(|e| e.to_string())?;
    let Image { width, height, channels, data } = &image;
    let (channels, first) = (*channels as usize, |pixel: &[u8]| match pixel {
        [v] | [v, _] => [*v; 3],
        [r, g, b, ..] => [*r, *g, *b],
        [] => [0; 3],
    });
    let rgb8 = match data {
        // These are developed already.
        ImageData::U8(values) => values.chunks(channels).flat_map(first).collect(),
        ImageData::U16(values) => {
            let values: Vec<u8> = values.iter().map(|v| (v >> 8) as u8).collect();
            values.chunks(channels).flat_map(first).collect()
        }
        ImageData::F32(values) => {
            let light = |pixel: &[f32]| match pixel {
                [v] | [v, _] => [*v; 3],
                [r, g, b, ..] => [*r, *g, *b],
                [] => [0.0; 3],
            };
            let rgb: Vec<[f32; 3]> = values.chunks(channels).map(light).collect();
            develop(*width, *height, &rgb, exposure, tonemap).rgb8
        }
    };
    encode_png(*width, *height, &rgb8, Packing::Quick).map_err(|e| e.to_string())
}
