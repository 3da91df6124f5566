//! Textures against oracles written by hand.
mod board;
mod filtered;
mod image;
mod mapping;
mod noise;
use std::sync::Arc;

use durer_core::{
    glam::DAffine3,
    math::{Normal3, Point2, Point3},
    spectrum::{Basis, Color},
};
use durer_model::{
    ShadeCx,
    texture::{Footprint, Texture, TextureAt, textures},
};
use durer_scene::{
    Args, AssetError, Assets, Diagnostics, Image, ImageData, Mesh, Missing, Node, Params, Ptex, PtexFace,
    PtexShape, TextureDesc, TextureValue,
};

/// One image under every name but "missing.png".
struct Files(Image);

impl Assets for Files {
    fn bytes(&self, path: &str) -> Result<Arc<[u8]>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn mesh(&self, path: &str) -> Result<Arc<Mesh>, AssetError> {
        Err(AssetError::Missing { path: path.to_owned() })
    }
    fn image(&self, path: &str) -> Result<Arc<Image>, AssetError> {
        match path {
            "missing.png" => Err(AssetError::Missing { path: path.to_owned() }),
            _ => Ok(Arc::new(self.0.clone())),
        }
    }
    /// A face that is the image's first texel.
    fn ptex(&self, _: &str) -> Result<Arc<Ptex>, AssetError> {
        let face = PtexFace { log2: [0, 0], first: 0, beside: [None; 4], is_part: false };
        let texels = Arc::new(self.0.clone());
        Ok(Arc::new(Ptex { shape: PtexShape::Quads, faces: vec![face], texels, passed_over: Vec::new() }))
    }
}

fn built(kind: &str, value: TextureValue, params: Params, image: &Image) -> Result<Box<dyn Texture>, String> {
    let (node, files) = (Node::new(kind, params), Files(image.clone()));
    let entry = textures(value).iter().find(|e| e.answers_to(kind)).expect("a registered word");
    let names = ["a", "b"].map(|n| TextureDesc {
        name: n.to_owned(),
        value,
        node: Node::default(),
        world_from_texture: DAffine3::IDENTITY,
    });
    let mut diagnostics = Diagnostics::default();
    let mut args =
        Args::check(&node, entry.schema, &names, &mut diagnostics).with_assets(&files, Missing::Warn);
    let texture = (entry.build)(&mut args);
    texture.ok_or_else(|| diagnostics.iter().map(|d| d.message.as_str()).collect::<Vec<_>>().join("; "))
}

fn at(u: f32, v: f32) -> TextureAt {
    TextureAt {
        uv: Point2::new(u, v),
        second_uv: Point2::new(u, v),
        face: 0,
        p: Point3::ZERO,
        n: Normal3::new(0.0, 0.0, 1.0),
        vertex_color: [1.0; 4],
        footprint: Footprint::POINT,
    }
}

/// What textures made of no others need.
const CX: ShadeCx<'static> = ShadeCx { basis: Basis::Rgb, textures: &[], log: None };

fn color(t: &dyn Texture, u: f32, v: f32) -> [f32; 3] {
    t.color(&CX, &at(u, v)).rgb
}

fn float(t: &dyn Texture, u: f32, v: f32) -> f32 {
    t.float(&CX, &at(u, v))
}

fn grey(width: u32, height: u32, data: Vec<f32>) -> Image {
    Image { width, height, channels: 1, data: ImageData::F32(data) }
}

#[test]
fn squares_own_their_lower_edges_also_below_zero() {
    let board =
        built("checkerboard", TextureValue::Float, Params::new(), &grey(1, 1, vec![0.0])).expect("a board");
    let row = |v: f32| {
        [-2.0, -1.5, -1.0, -1e-7, -0.0, 0.0, 0.999_999_9, 1.0, 2.0].map(|u| float(board.as_ref(), u, v))
    };
    assert_eq!(row(0.0), [1., 1., 0., 0., 1., 1., 1., 0., 1.]);
    assert_eq!(row(-1.0), [0., 0., 1., 1., 0., 0., 0., 1., 0.]);
    assert_eq!(float(board.as_ref(), 16_777_216.0, 1.0), 0.0);
}

#[test]
fn boards_and_products_refer_to_other_textures() {
    let image = grey(1, 1, vec![0.0]);
    let make = |kind, params| built(kind, TextureValue::Color, params, &image).expect("sound parameters");
    let others =
        [make("constant", Params::new().rgb("value", [0.1, 0.2, 0.3])), make("constant", Params::new())];
    let cx = ShadeCx { basis: Basis::Rgb, textures: &others, log: None };
    let board =
        make("checkerboard", Params::new().texture("tex1", "a").texture("tex2", "b").float("uscale", 4.0));
    assert_eq!(board.color(&cx, &at(0.1, 0.1)), Color::new(0.1, 0.2, 0.3));
    assert_eq!(board.color(&cx, &at(0.3, 0.1)), Color::WHITE);
    let product = make("scale", Params::new().texture("tex", "a").float("scale", 2.0));
    assert_eq!(product.color(&cx, &at(0.0, 0.0)), Color::new(0.2, 0.4, 0.6));
    let unknown = built("scale", TextureValue::Color, Params::new().texture("tex", "c"), &image);
    assert!(unknown.is_err_and(|m| m.contains("\"c\"")));
}

#[test]
fn every_texture_is_registered_for_colours_and_numbers() {
    let names = |value| textures(value).iter().map(|e| e.schema.name).collect::<Vec<_>>();
    assert_eq!(names(TextureValue::Color), names(TextureValue::Float));
    assert!(names(TextureValue::Color).contains(&"imagemap"));
    let image = Image { width: 1, height: 1, channels: 3, data: ImageData::U8(vec![255; 3]) };
    for value in [TextureValue::Color, TextureValue::Float] {
        for entry in textures(value) {
            let file = entry.schema.params.iter().any(|p| p.name == "filename");
            let params = if file { Params::new().string("filename", "x") } else { Params::new() };
            let texture = built(entry.schema.name, value, params, &image).expect("built from defaults");
            let (rgb, number) = (color(texture.as_ref(), 0.5, 0.5), float(texture.as_ref(), 0.5, 0.5));
            let luminance = (Color { rgb }).luminance();
            assert!((luminance - number).abs() < 1e-6, "{}: {rgb:?} {number}", entry.schema.name);
            let largest = texture.largest(&CX);
            assert!(
                rgb.iter().all(|c| c.abs() <= largest) && number.abs() <= largest,
                "{}",
                entry.schema.name
            );
        }
    }
}
