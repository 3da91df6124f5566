// The twin of povray_spheres.pbrt for POV-Ray 3.7: glass and mirror over a checkerboard, one point light.
// Both files are this project's own. `cargo xtask bench render` runs them one after the other; by hand:
//   povray +Ipovray_spheres.pov +W1280 +H960 +WT2 -D -V +Oout.png
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 10 }
background { rgb <0.3, 0.5, 0.8> }
camera { perspective location <0, 2, -6> look_at <0, 1, 0> right x*4/3 up y angle 53.13 }
light_source { <-4, 6, -5> rgb 1.6 }
plane { y, 0 pigment { checker rgb 0.1 rgb 0.9 } finish { ambient 0.05 diffuse 0.9 } }
sphere {
  <-1.1, 1, 0>, 1
  pigment { rgbt <1, 1, 1, 1> }
  finish { ambient 0 diffuse 0 specular 0.6 roughness 0.002 reflection { 0 1 fresnel on } conserve_energy }
  interior { ior 1.5 }
}
sphere { <1.1, 1, 0.5>, 1 pigment { rgb 0 } finish { ambient 0 diffuse 0 reflection 0.95 } }
