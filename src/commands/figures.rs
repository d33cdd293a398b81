//! `apertura figures`: every figure of the thesis from this program.

use super::arguments::whole;
use super::figure::save;
use super::{CommandError, print, write_file};
use crate::figures::{ALL, Figure, SceneSource, by_number, pages};
use crate::methods;
use crate::radar::counted;
use crate::reconstruct::Reconstructor;
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::Arc;

/// Draw the thesis' figures and tables from this program's own data
///
/// Writes figures/NUMBER.png and .svg into DIR, and figures.md, the page that shows them all with what differs from the printed
/// ones. Figures without simulated data are kept as drawn in docs/figures: they are named, and not written.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Draw these figures alone, as 4-7 or 2-2,2-6; leaves figures.md as it is
    #[arg(long, value_delimiter = ',', value_name = "NUMBERS")]
    only: Vec<String>,

    /// Test scenes a set for tables 4.1 to 4.3
    #[arg(long, default_value_t = 10, value_name = "N", value_parser = whole(1..=10_000u32))]
    scenes: u32,

    /// Folder to write into
    #[arg(short, long, value_name = "DIR", default_value = "docs")]
    output: PathBuf,
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let chosen = self.chosen()?;
        let folder = self.output.join("figures");
        let source = SceneSource::default();
        let mut drawn = 0;
        for figure in &chosen {
            let Some(sheet) = figure.sheet else {
                print(&format!("figure {}: kept as drawn", figure.number))?;
                continue;
            };
            let failed = |e| CommandError(format!("figure {}: {e}", figure.number));
            let sheet = sheet(&source).map_err(failed)?;
            save(&sheet, &folder, figure.number)?;
            print(&format!("figure {}", figure.number))?;
            drawn += 1;
        }
        if self.only.is_empty() {
            write_file(&self.output.join("figures.md"), self.page()?.as_bytes())?;
        }
        print(&format!("wrote {} into {}", counted(drawn, "figure", "figures"), folder.display()))
    }

    fn chosen(&self) -> Result<Vec<&'static Figure>, CommandError> {
        if self.only.is_empty() {
            return Ok(ALL.iter().collect());
        }
        let unknown = |number: &str| {
            let known: Vec<&str> = ALL.iter().map(|f| f.number).collect();
            CommandError(format!("there is no figure \"{number}\"; known: {}", known.join(", ")))
        };
        self.only.iter().map(|number| by_number(number.trim()).ok_or_else(|| unknown(number))).collect()
    }

    fn page(&self) -> Result<String, CommandError> {
        let named = pages::TABLE_METHODS.iter().map(|(name, _)| methods::by_name(name));
        let methods: Vec<Arc<dyn Reconstructor>> = named.collect::<Result<_, _>>()?;
        let methods: Vec<&dyn Reconstructor> = methods.iter().map(AsRef::as_ref).collect();
        let mut page = String::from(
            "# The thesis' figures\n\nDrawn by `apertura figures`, which also writes this page and an SVG beside every PNG that it draws. Figures *kept as drawn*\nshow no simulated data and are not drawn again.\n",
        );
        let _ = writeln!(page, "\n<!-- table figures: apertura figures --scenes {} -->", self.scenes);
        page.push_str(&pages::tables(&methods, self.scenes)?);
        page.push_str("## Figures\n\n");
        page.extend(ALL.iter().map(|figure| pages::entry(figure, "figures")));
        // `scripts/tables` names the weights and the floor's edition here.
        page.push_str("<!-- /table -->\n");
        Ok(page)
    }
}
