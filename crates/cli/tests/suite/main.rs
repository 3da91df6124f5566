//! The built binary, run in folders of its own.

mod complaints;
mod convert;
mod cost;
mod environment;
mod frames;
mod info;
mod interrupt;
mod pictures;
mod run;
mod statistics;
mod table;
mod trace_files;
mod traces;
mod usage;
mod view;
mod words;
