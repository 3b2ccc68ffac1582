//! What the program says of itself: dictionary, schema of the study file, completions, manual pages.

use anyhow::Context;
use clap::CommandFactory;
use clap_complete::Shell;
use pipeline::Words;
use std::io::stdout;
use std::path::Path;

use crate::args::{Args, DictionaryFormat, StudyArgs};
use crate::console::say;
use crate::failure::{Ending, Failure};
use crate::{STUDY_FILE, open};

/// The name of the program and of its manual.
const NAME: &str = "busclimate";

pub fn dictionary(typed: &StudyArgs, format: DictionaryFormat) -> Result<Ending, Failure> {
    let words = match format {
        DictionaryFormat::Markdown => Words::Markdown,
        DictionaryFormat::Questions => Words::Questions,
        DictionaryFormat::Json => Words::Json,
        DictionaryFormat::Datasette => Words::Datasette,
    };
    // Only Datasette asks for the name of the database's file.
    let there = typed.study.is_some() || typed.db.is_some() || Path::new(STUDY_FILE).exists();
    let database = if format == DictionaryFormat::Datasette && there {
        open(typed)?.database.file_stem().map(|stem| stem.to_string_lossy().into_owned())
    } else {
        None
    };
    let text = pipeline::words(words, database.as_deref().unwrap_or("study"))?;
    say(format_args!("{}", text.trim_end()))?;
    Ok(Ending::Done)
}

pub fn schema() -> Result<Ending, Failure> {
    say(format_args!("{}", study::schema()))?;
    Ok(Ending::Done)
}

pub fn completions(shell: Shell) -> Result<Ending, Failure> {
    clap_complete::generate(shell, &mut Args::command(), NAME, &mut stdout());
    Ok(Ending::Done)
}

pub fn man(dir: &Path) -> Result<Ending, Failure> {
    let pages = std::fs::create_dir_all(dir).and_then(|()| clap_mangen::generate_to(Args::command().name(NAME), dir));
    pages.with_context(|| format!("cannot write manual pages into {}", dir.display())).map_err(Failure::Usage)?;
    say(format_args!("{} has the manual pages; man {NAME} begins", dir.display()))?;
    Ok(Ending::Done)
}
