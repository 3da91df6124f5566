//! OpenVDB files that are made here: what is read of them, and what small files cannot make of themselves.
use durer_io::FileAssets;
use durer_scene::{AssetError, Assets, Limits, Voxels};

/// What a node of children says of a child.
enum Child {
    /// All its voxels have this value.
    Tile(f32),
    /// A node of 16 children along an axis, of which the first is a leaf with voxel `(x, y, z)` at `x + 10 y + 100 z`.
    Leaf,
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

fn mask(count: usize, on: impl Iterator<Item = usize>) -> Vec<u8> {
    let mut bytes = vec![0; count / 8];
    on.for_each(|i| bytes[i / 8] |= 1 << (i % 8));
    bytes
}

/// Values of the active ones, others are left out.
fn values(values: &[f32]) -> Vec<u8> {
    [vec![0], values.iter().flat_map(|v| v.to_le_bytes()).collect()].concat()
}

/// A node of 32 children along an axis, of which the first ones are these, and the values of its leaves.
fn node(origin: [i32; 3], children: &[Child]) -> [Vec<u8>; 2] {
    let mut bytes: Vec<u8> = origin.iter().flat_map(|c| c.to_le_bytes()).collect();
    let is_leaf = |i: &usize| matches!(children[*i], Child::Leaf);
    let tiles: Vec<f32> =
        children.iter().filter_map(|c| if let Child::Tile(v) = c { Some(*v) } else { None }).collect();
    bytes.extend(mask(32_768, (0..children.len()).filter(is_leaf)));
    bytes.extend(mask(32_768, (0..children.len()).filter(|i| !is_leaf(i))));
    bytes.extend(values(&tiles));
    let mut leaves = Vec::new();
    let all = mask(512, 0..512);
    for _ in (0..children.len()).filter(is_leaf) {
        bytes.extend([mask(4096, 0..1), mask(4096, 0..0), values(&[]), all.clone()].concat());
        // In the file z changes fastest.
        let ramp: Vec<f32> = (0..512).map(|n| (n / 64 + n / 8 % 8 * 10 + n % 8 * 100) as f32).collect();
        leaves.extend([all.clone(), values(&ramp)].concat());
    }
    [bytes, leaves]
}

/// A file with one grid, `density`, in which voxel `i` lies at `i`; tiles of 4096 voxels along an axis, and nodes.
fn file(tiles: &[([i32; 3], f32)], nodes: &[[Vec<u8>; 2]]) -> Vec<u8> {
    let head = [
        &[0x20, 0x42, 0x44, 0x56, 0, 0, 0, 0][..],
        &[224u32, 6, 2].map(u32::to_le_bytes).concat(),
        &[1],
        &[b'0'; 36],
        &[0u32, 1].map(u32::to_le_bytes).concat(),
        &[text("density"), text("Tree_float_5_4_3"), text("")].concat(),
    ]
    .concat();
    let scale = [1.0f64; 15].map(f64::to_le_bytes).concat();
    let counts = [1, 0, tiles.len() as u32, nodes.len() as u32].map(u32::to_le_bytes).concat();
    let mut grid =
        [&[2u32, 0].map(u32::to_le_bytes).concat()[..], &text("ScaleMap"), &scale, &counts].concat();
    for (origin, value) in tiles {
        grid.extend(origin.iter().flat_map(|c| c.to_le_bytes()));
        grid.extend(value.to_le_bytes());
        grid.push(1);
    }
    nodes.iter().for_each(|[tree, _]| grid.extend(tree));
    nodes.iter().for_each(|[_, leaves]| grid.extend(leaves));
    let at = head.len() + 24;
    let places = [at, at, at + grid.len()].map(|place| (place as i64).to_le_bytes()).concat();
    [head, places, grid].concat()
}

fn read(bytes: Vec<u8>) -> Result<Voxels, AssetError> {
    let mut assets = FileAssets::new("".into(), Limits::default());
    assets.insert("a.vdb", bytes);
    assets.voxels("a.vdb", "density")
}

fn refused(bytes: Vec<u8>) -> String {
    match read(bytes) {
        Err(AssetError::Limits { reason, .. }) => reason,
        other => panic!("{other:?}"),
    }
}

#[test]
fn leaves_and_tiles_stand_where_the_file_says() {
    let voxels = read(file(&[], &[node([0; 3], &[Child::Leaf, Child::Tile(7.0)])])).expect("a sound file");
    // A leaf at the origin, beside it in z a cube of 128 voxels, and an empty block around both.
    assert_eq!(voxels.size, [144, 144, 272]);
    assert_eq!(voxels.value([8 + 3, 8 + 5, 8 + 7]), 753.0);
    assert_eq!(voxels.value([8, 8, 8 + 127]), 0.0);
    for inside in [[8, 8, 136], [135, 135, 263]] {
        assert_eq!(voxels.value(inside), 7.0);
    }
    assert_eq!((voxels.value([7, 8, 136]), voxels.value([8, 8, 264])), (0.0, 0.0));
    assert_eq!((voxels.most(), voxels.most_in([[8, 143], [8, 143], [136, 271]])), (777.0, 7.0));
}

#[test]
fn what_is_cut_off_is_told() {
    let whole = file(&[], &[node([0; 3], &[Child::Leaf, Child::Tile(7.0)])]);
    for end in (0..200).chain((200..whole.len()).step_by(97)) {
        assert!(matches!(read(whole[..end].to_vec()), Err(AssetError::Format { .. })), "{end} bytes");
    }
}

/// Of 17 bytes, two thousand million voxels.
#[test]
fn a_tile_of_the_root_is_too_large() {
    assert!(refused(file(&[([0; 3], 1.0)], &[])).contains("too large or too far spread"));
    let twice = [([0; 3], 1.0), ([4096, 0, 0], 1.0)];
    assert!(refused(file(&twice, &[])).contains("more than a file of this length holds"));
}

/// Each of these four bytes would become two thousand.
#[test]
fn a_small_file_does_not_fill_memory_by_tiles() {
    let differ = |first: usize| {
        let tiles: Vec<Child> = (first..first + 32_000).map(|i| Child::Tile(1.0 + i as f32)).collect();
        node([first as i32 * 4096, 0, 0], &tiles)
    };
    let nodes: Vec<_> = (0..4).map(|i| differ(i * 32_000)).collect();
    assert!(refused(file(&[], &nodes)).contains("more than a file of this length holds"));
}

#[test]
fn what_is_filled_again_and_again_is_refused() {
    let full = || node([0; 3], &(0..32_768).map(|_| Child::Tile(1.0)).collect::<Vec<_>>());
    assert!(refused(file(&[], &[full(), full()])).contains("more than a file of this length holds"));
}
