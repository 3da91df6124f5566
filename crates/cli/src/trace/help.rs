//! What `durer trace --help` says at its end.

pub(super) const EXAMPLES: &str = "\
Examples:
  durer trace --pixel 640,360
  durer trace room.glb --pixel 320,240 --sample 7 --spp 64
  durer trace --pixel 640,360 --json | jq '.nodes[] | select(.kind == \"shadow\")'
  durer trace --pixel 640,360 -o tree.html                  to explore, in any browser
  durer trace --pixel 640,360 -o tree.svg -o tree.glb       for paper, for a 3D viewer
  durer trace --pixel 640,360 --diff '--max-depth 2'        what the depth limit takes away
  durer trace cook --pixel 200,90 --diff '--integrator whitted'
  durer trace room.glb --find firefly --spp 64 -o worst.html
  durer trace room.glb --pixel 10,20 --sample brightest

Give the options of the render whose sample you want: the size and --spp decide
where in the pixel a sample lies. With --sample all the last line, `pixel R G B`,
has the very bits of the pixel in `durer render -o x.exr`. So it has without where
the pixel has one sample, as with --spp 1 unless rays are distributed: nested, a
pixel has --spp times --time-samples times --lens-samples of them; shared, as many
as the largest of these numbers, --shadow-rays and --gloss-rays. The first line
says how many there are. With --antialias adaptive the samples are, in this
order: the pixel's corners (upper left, upper right, lower left, lower right),
then for each split what is new of the middles of its upper and left edges, its
centre and the middles of its right and lower edges; a part that is split no
further may have one more inside.

--find takes every sample of the picture, which is as much work as rendering it:
  firefly    the sample whose luminance lies farthest above the brightest mean of
             the pixels around it, and of its own pixel without it (3 x 3 pixels)
  nan        the first sample that is infinite or NaN
  deepest    the sample with the most bounces
  costliest  the sample with the most tests of boxes and primitives
It says on stderr what it found; Ctrl-C ends it with the worst so far.

--diff traces the same samples with the same random numbers under other options
and says which rays are gone, new or changed. Rays correspond if they are the
n-th of their kind and light below rays that correspond.

Files by suffix: .html one page that needs no network, .json all keys, .svg the
tree drawn beside the picture, .dot for Graphviz, .glb the rays as lines in the
scene, .csv a row per ray, .md a nested list. The keys of the JSON, with units,
are described in docs/ray-tree.md; within a version keys may be added, none
renamed.";
