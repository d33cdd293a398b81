//! PNG files with the name of this program in them, so that it may replace them without asking.

use super::canvas::PictureError;
use image::codecs::png::{PngDecoder, PngEncoder};
use image::{ExtendedColorType, ImageDecoder, ImageEncoder, RgbImage};
use std::io::Cursor;

/// Exif with a single entry, Software (0x0131), in little-endian TIFF: header, one directory of one entry, and its text.
const EXIF: &[u8] = b"II\x2a\x00\x08\x00\x00\x00\
\x01\x00\x31\x01\x02\x00\x09\x00\x00\x00\x1a\x00\x00\x00\x00\x00\x00\x00\
apertura\x00";

/// The picture as a PNG file's bytes.
/// # Errors
/// [`PictureError`] when the encoder refuses.
pub fn encode_png(picture: &RgbImage) -> Result<Vec<u8>, PictureError> {
    let mut bytes = Vec::new();
    let mut encoder = PngEncoder::new(&mut bytes);
    encoder.set_exif_metadata(EXIF.to_vec()).map_err(PictureError::new)?;
    encoder
        .write_image(picture.as_raw(), picture.width(), picture.height(), ExtendedColorType::Rgb8)
        .map_err(PictureError::new)?;
    Ok(bytes)
}

/// Whether a file's bytes are a PNG that [`encode_png`] made.
pub fn is_our_png(bytes: &[u8]) -> bool {
    PngDecoder::new(Cursor::new(bytes))
        .and_then(|mut d| d.exif_metadata())
        .is_ok_and(|exif| exif.as_deref() == Some(EXIF))
}
