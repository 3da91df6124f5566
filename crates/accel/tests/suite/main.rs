//! What durer-accel promises, checked on seeded random scenes. `DURER_SLOW=1` takes
//! twenty times as many rays, `DURER_QUICK=1` a tenth.
mod animation;
mod bending;
mod corpus;
mod curves;
mod edge_cases;
mod equality;
mod filtered;
mod fuzz;
mod icosphere;
mod instancing;
mod near_misses;
mod points;
mod properties;
mod shapes;
mod sizes;
mod triangle;
mod watertight;
