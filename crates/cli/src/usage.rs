//! What is wrong with the words of a command line, and what may have been meant.
use std::{error::Error as _, path::Path, process::ExitCode};

use clap::{
    Command, CommandFactory, Error,
    error::{ContextKind, ContextValue, ErrorKind},
};
use durer::{builtin, scene::nearest_word};

use crate::{
    Cli,
    exit::{Exit, harmless, tell},
    load::is_scene_file,
};

/// A complaint, and what to do.
type Said = (String, Option<String>);

/// Prints what the parser has to say of `words`, which begin with the program's name: help, or a complaint.
pub(crate) fn explain(error: &Error, words: &[String]) -> ExitCode {
    let program = Cli::command();
    let named = words.iter().skip(1).find_map(|word| program.find_subcommand(word));
    let said = match error.kind() {
        ErrorKind::UnknownArgument => unknown_argument(error, words, named, &program),
        ErrorKind::InvalidSubcommand => text(error, ContextKind::InvalidSubcommand).map(no_command),
        ErrorKind::InvalidValue => unknown_value(error),
        ErrorKind::ValueValidation => wrong_value(error),
        _ => None,
    };
    let Some((message, help)) = said else {
        // Nothing can be done if the stream is closed.
        let _ = error.print();
        return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(Exit::Usage as u8));
    };
    let help = help.unwrap_or_else(|| match named {
        Some(command) => format!("durer {} --help tells what there is", command.get_name()),
        None => "durer --help tells what there is".to_owned(),
    });
    tell(&harmless(&format!("error: {message}\n  help: {help}")));
    Exit::Usage.into()
}

fn text(error: &Error, kind: ContextKind) -> Option<&str> {
    match error.get(kind)? {
        ContextValue::String(text) => Some(text),
        _ => None,
    }
}

fn no_command(word: &str) -> Said {
    if is_scene_file(word) || builtin::find(word).is_some() || Path::new(word).is_file() {
        let command = format!("to render it: durer render {word}");
        return (format!("'{word}' is a scene, and a command is missing"), Some(command));
    }
    let commands = Cli::command();
    let names: Vec<&str> = commands.get_subcommands().map(Command::get_name).collect();
    let help = match nearest_word(word, names.iter().copied()) {
        Some(near) => format!("did you mean '{near}'?"),
        None => format!("commands: {}", names.join(", ")),
    };
    (format!("unknown command '{word}'"), Some(help))
}

fn unknown_argument(
    error: &Error,
    words: &[String],
    named: Option<&Command>,
    program: &Command,
) -> Option<Said> {
    let found = text(error, ContextKind::InvalidArg)?;
    let message = format!("unexpected argument '{found}'");
    let Some(command) = named else { return Some((message, None)) };
    let name = command.get_name();
    let Some(long) = found.strip_prefix("--") else {
        return Some(match found.strip_prefix('-') {
            Some(short) => unknown_short(short, words, command),
            None if takes_scene(command) => (message, Some(format!("{name} takes one scene"))),
            None => (message, None),
        });
    };
    if option(command, long).is_some() {
        return Some((message, Some(format!("options follow the command: durer {name} --{long}"))));
    }
    let others: Vec<&str> =
        program.get_subcommands().filter(|c| option(c, long).is_some()).map(Command::get_name).collect();
    if let Some((last, before)) = others.split_last() {
        let have = if before.is_empty() { "has" } else { "have" };
        let others =
            [before.join(", "), (*last).to_owned()].join(if before.is_empty() { "" } else { " and " });
        return Some((format!("{name} has no --{long}; {others} {have}"), None));
    }
    Some((message, near(command, long)))
}

/// One dash and many letters may want two dashes.
fn unknown_short(short: &str, words: &[String], command: &Command) -> Said {
    let typed = words.iter().filter_map(|word| word.strip_prefix('-'));
    let mut typed = typed.filter(|word| !word.starts_with('-') && word.contains(short));
    let word = typed.next().unwrap_or(short);
    let long = word.split('=').next().unwrap_or(word);
    let help = if long.chars().count() > 1 { near(command, long) } else { None };
    (format!("unexpected argument '-{word}'"), help)
}

fn takes_scene(command: &Command) -> bool {
    command.get_positionals().any(|p| p.get_id() == "scene")
}

/// The option of this name, under its first name.
fn option<'a>(command: &'a Command, long: &str) -> Option<&'a str> {
    let found = command.get_arguments().find(|arg| {
        arg.get_long() == Some(long) || arg.get_all_aliases().is_some_and(|all| all.contains(&long))
    });
    found?.get_long()
}

fn near(command: &Command, long: &str) -> Option<String> {
    let names = command.get_arguments().filter(|arg| arg.get_long().is_some());
    let names: Vec<&str> =
        names.flat_map(|a| a.get_long().into_iter().chain(a.get_all_aliases().unwrap_or_default())).collect();
    let near = option(command, nearest_word(long, names)?)?;
    Some(format!("did you mean '--{near}'?"))
}

/// A value that is none of the words an option knows; `None` if there is no value at all.
fn unknown_value(error: &Error) -> Option<Said> {
    let value = text(error, ContextKind::InvalidValue).filter(|value| !value.is_empty())?;
    let option = text(error, ContextKind::InvalidArg)?;
    let Some(ContextValue::Strings(valid)) = error.get(ContextKind::ValidValue) else { return None };
    let list = valid.join(", ");
    let help = match nearest_word(value, valid.iter().map(String::as_str)) {
        Some(near) => format!("did you mean '{near}'? There are: {list}"),
        None => format!("there are: {list}"),
    };
    Some((format!("invalid value '{value}' for '{option}'"), Some(help)))
}

/// A value that an option's own reader refuses, with the reader's words.
fn wrong_value(error: &Error) -> Option<Said> {
    let value = text(error, ContextKind::InvalidValue)?;
    let option = text(error, ContextKind::InvalidArg)?;
    let why = error.source()?;
    Some((format!("invalid value '{value}' for '{option}': {why}"), None))
}
