//! Contact sheets: many pictures on one, each with its name below it.
use std::path::Path;

use font8x8::UnicodeFonts;

use super::{Outcome, Tried, picture::Picture};

/// Pictures per row, and rows per sheet.
const GRID: [u32; 2] = [4, 5];
/// Pixels around each picture.
const GAP: u32 = 6;
/// Pixels of a letter.
const LETTER: u32 = 8;
/// Letters start on lines so far apart.
const LINE: u32 = 11;
/// Lines of text below a picture.
const LINES: u32 = 2;

const PAPER: [u8; 3] = [32, 32, 34];
const INK: [u8; 3] = [235, 235, 230];
const REFUSED: [u8; 3] = [90, 40, 40];

/// Writes `sheet-FORMAT-N.png` into the folder; each picture as wide as it was drawn.
pub(super) fn write(folder: &Path, format: &str, tried: &[Tried], width: u32) -> anyhow::Result<()> {
    let tallest = tried.iter().filter_map(|t| t.picture.as_ref()).map(|p| p.height).max();
    let height = tallest.unwrap_or(width * 9 / 16);
    for (number, part) in (1..).zip(tried.chunks((GRID[0] * GRID[1]) as usize)) {
        sheet(part, [width, height]).write(&folder.join(format!("sheet-{format}-{number}.png")))?;
    }
    Ok(())
}

fn sheet(tried: &[Tried], [width, height]: [u32; 2]) -> Picture {
    let cell = [width + GAP, height + GAP + LINES * LINE];
    let rows = (tried.len() as u32).div_ceil(GRID[0]);
    let mut sheet = Picture::plain(GRID[0] * cell[0] + GAP, rows * cell[1] + GAP, PAPER);
    for (index, one) in (0..).zip(tried) {
        let at = [GAP + index % GRID[0] * cell[0], GAP + index / GRID[0] * cell[1]];
        match &one.picture {
            Some(picture) => sheet.place(picture, at),
            None => {
                sheet.place(&Picture::plain(width, height, REFUSED), at);
                if let Outcome::Refused(reason) = &one.outcome {
                    write_lines(
                        &mut sheet,
                        &format!("refused: {reason}"),
                        [at[0] + 4, at[1] + 4],
                        [width - 8, 8],
                    );
                }
            }
        }
        write_lines(&mut sheet, &one.model.file, [at[0], at[1] + height + 2], [width, LINES]);
    }
    sheet
}

/// Text from a corner on, in so many lines at most, each at most so wide.
fn write_lines(sheet: &mut Picture, text: &str, [x, y]: [u32; 2], [width, lines]: [u32; 2]) {
    let per_line = (width / LETTER).max(1);
    for (index, letter) in (0..per_line * lines).zip(text.chars()) {
        let corner = [x + index % per_line * LETTER, y + index / per_line * LINE];
        write_letter(sheet, letter, corner);
    }
}

fn write_letter(sheet: &mut Picture, letter: char, [x, y]: [u32; 2]) {
    let Some(rows) = font8x8::BASIC_FONTS.get(letter).or_else(|| font8x8::BASIC_FONTS.get('?')) else {
        return;
    };
    let dot = Picture::plain(1, 1, INK);
    for (row, bits) in (0..).zip(rows) {
        (0..LETTER).filter(|column| bits >> column & 1 == 1).for_each(|column| {
            sheet.place(&dot, [x + column, y + row]);
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::corpus::Model;

    #[test]
    fn pictures_stand_in_rows_with_names_below() {
        let one = |picture: Option<Picture>| Tried {
            model: Model { file: "a/b.ply".to_owned(), credit: None },
            outcome: Outcome::Refused("too short".to_owned()),
            thumbnail: None,
            picture,
        };
        let green = [0, 255, 0];
        let tried = [Some(Picture::plain(80, 40, green)), None].map(one);
        let sheet = sheet(&tried, [80, 40]);
        assert_eq!((sheet.width, sheet.height), (4 * 86 + 6, 40 + 6 + 22 + 6));
        let count = |color: [u8; 3]| sheet.rgb.iter().filter(|&&c| c == color).count();
        assert_eq!(count(green), 80 * 40);
        assert!(count(REFUSED) > 80 * 40 / 2 && count(INK) > 100);
    }
}
