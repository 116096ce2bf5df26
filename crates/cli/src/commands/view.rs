//! `etalon view`.

use super::{answer, fail};
use crate::args::ViewArgs;
use crate::preview::{self, Feed};
use std::process::ExitCode;
use std::sync::Arc;

/// Shows finished pictures in a page until the program is ended.
pub fn run(args: &ViewArgs) -> ExitCode {
    match open(args) {
        Ok(address) => {
            let told = format!("look at {address}\nCtrl-C ends it.\n");
            if answer(&told, ExitCode::SUCCESS) != ExitCode::SUCCESS {
                return ExitCode::from(super::BAD_INPUT);
            }
            loop {
                std::thread::park();
            }
        }
        Err(message) => fail(message),
    }
}

fn open(args: &ViewArgs) -> Result<String, String> {
    let development = args.shown.development()?;
    let files = [Some(&args.file), args.other.as_ref()];
    let names = files.map(|file| file.map(|file| file.display().to_string()));
    let title = names
        .into_iter()
        .flatten()
        .collect::<Vec<_>>()
        .join(" and ");
    let feed = Arc::new(Feed::new(title, development));
    for file in files.into_iter().flatten() {
        feed.add(file, preview::shown(file)?);
    }
    preview::open(&feed, args.port.and_then(|port| port.0))
}
