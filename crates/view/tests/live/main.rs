//! The server as a page meets it: over real sockets.
mod archive;
mod client;
mod develop;
mod door;
mod forms;
mod picture;
mod pose;
mod rays;
mod reload;
mod save;
mod viewers;
