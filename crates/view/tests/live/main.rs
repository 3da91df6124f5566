//! The server as a page meets it: over real sockets.
mod client;
mod door;
mod forms;
mod picture;
mod rays;
mod reload;
mod save;
mod viewers;
