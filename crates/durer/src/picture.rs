//! From a film to picture files: developed for the eye (PNG), or as it is, with its story (OpenEXR).
use std::{error::Error, time::Duration};

use crate::{
    Output, Prepared, Show, View,
    film::{DepthRange, Developed, Layer, Layers, Pixel, ToneMap, develop, develop_data, develop_survey},
    image::{ExrPicture, ExrValue, NamedChannel, Packing, PictureFormat, encode_exr, encode_png},
};

/// How light becomes 8-bit colours.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    /// Stops of brightening.
    pub exposure: f32,
    /// The tone map.
    pub tonemap: ToneMap,
}

/// A rendered picture on its way into files.
pub struct Picture<'a> {
    /// As the user named it.
    pub scene: &'a str,
    /// What it shows.
    pub prepared: &'a Prepared,
    /// The film's pixels.
    pub pixels: Vec<Pixel>,
    /// What the film holds beside colours.
    pub layers: Vec<Layer>,
    /// The time it took.
    pub render: Duration,
    /// It is not complete.
    pub interrupted: bool,
}

impl Look {
    /// The tone map for light of an integrator, if nobody asks for another: light that is computed as in the lecture is
    /// shown as it was there.
    pub fn usual_tonemap(integrator: &str) -> ToneMap {
        match integrator {
            "cast" | "whitted" | "distributed" => ToneMap::None,
            _ => ToneMap::Agx,
        }
    }
}

impl Picture<'_> {
    /// The bytes of its file.
    ///
    /// # Errors
    /// If there is no room for it in the format.
    pub fn encode(&self, format: PictureFormat, look: Look) -> Result<Vec<u8>, Box<dyn Error + Send + Sync>> {
        Ok(match format {
            PictureFormat::Png => {
                let Developed { width, height, rgb8 } = self.develop(look);
                encode_png(width, height, &rgb8, Packing::Small)?
            }
            PictureFormat::Exr => encode_exr(&self.linear())?,
        })
    }

    /// Nearest and farthest depth of a depth picture: what its PNG scales to.
    pub fn depth_range(&self) -> Option<DepthRange> {
        match self.output() {
            Output::Data(Show::Depth) => {
                develop_data(Show::Depth, self.view().width, self.view().height, &self.data()).depth
            }
            _ => None,
        }
    }

    /// Tests of a white pixel of a cost picture.
    pub fn white_tests(&self) -> Option<f32> {
        match self.output() {
            Output::Data(Show::Cost) => {
                develop_data(Show::Cost, self.view().width, self.view().height, &self.data()).white_tests
            }
            _ => None,
        }
    }

    fn output(&self) -> Output {
        self.prepared.integrator.facts().output
    }

    fn view(&self) -> &View {
        &self.prepared.scene.view
    }

    fn data(&self) -> Vec<Option<[f32; 3]>> {
        self.pixels.iter().map(|p| (p.weight != 0.0).then(|| p.mean())).collect()
    }

    /// For the eye.
    pub fn develop(&self, look: Look) -> Developed {
        let (width, height) = (self.view().width, self.view().height);
        match self.output() {
            Output::Data(show) => develop_data(show, width, height, &self.data()).picture,
            Output::Survey(survey) => develop_survey(survey, width, height, &self.data()).0,
            Output::Radiance => {
                let rgb: Vec<[f32; 3]> = self.pixels.iter().map(Pixel::mean).collect();
                develop(width, height, &rgb, look.exposure, look.tonemap)
            }
        }
    }

    /// The means of the film, whatever they mean; zero where nothing was hit.
    fn linear(&self) -> ExrPicture {
        let channel = |(index, name): (usize, &&str)| NamedChannel {
            name: (*name).to_owned(),
            values: self.pixels.iter().map(|p| p.mean()[index]).collect(),
        };
        let beside =
            |Layer { name, values }: &Layer| NamedChannel { name: name.clone(), values: values.clone() };
        let colors = channel_names(self.output()).iter().enumerate().map(channel);
        ExrPicture {
            width: self.view().width,
            height: self.view().height,
            channels: colors.chain(self.layers.iter().map(beside)).collect(),
            attributes: self.story(),
        }
    }

    fn story(&self) -> Vec<(String, ExrValue)> {
        let text = |t: &str| ExrValue::Text(t.to_owned());
        let samples = self.prepared.settings.samples;
        let mut story = vec![
            ("durer.version", text(env!("CARGO_PKG_VERSION"))),
            ("durer.scene", text(self.scene)),
            ("durer.integrator", text(&self.prepared.integrator_name)),
            ("durer.spp", ExrValue::Integer(i32::try_from(samples).unwrap_or(i32::MAX))),
            // Text, as OpenEXR has no whole numbers of 64 bits.
            ("durer.seed", text(&self.prepared.settings.seed.to_string())),
            ("durer.seconds", ExrValue::Number(self.render.as_secs_f64())),
            ("durer.world_from_camera", ExrValue::Matrix(world_from_camera(self.view()))),
        ];
        if self.interrupted {
            story.push(("durer.interrupted", ExrValue::Integer(1)));
        }
        if matches!(self.view().layers, Some(Layers::Buckets(_))) && !self.layers.is_empty() {
            // Of the layout for spectral images, which has no unit for light that was scaled.
            story.push(("spectralLayoutVersion", text("1.0")));
            story.push(("emissiveUnits", text("W.m^-2.sr^-1")));
        }
        story.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
    }
}

/// What the numbers of a pixel are called in a file.
fn channel_names(output: Output) -> &'static [&'static str] {
    match output {
        Output::Radiance | Output::Data(Show::Shading | Show::Albedo) => &["R", "G", "B"],
        Output::Data(Show::Depth) => &["depth.Z", "depth.length"],
        Output::Data(Show::Normal) => &["normal.X", "normal.Y", "normal.Z"],
        Output::Data(Show::Uv) => &["uv.U", "uv.V"],
        Output::Data(Show::Id) => &["id"],
        Output::Data(Show::Cost) => &["cost.primitives", "cost.boxes"],
        Output::Survey(_) => &["survey.rays", "survey.Y", "survey.Y2"],
    }
}

/// Rows of the matrix that takes column vectors from the camera to the world when the shutter opens. The camera looks along +z, y up.
fn world_from_camera(view: &View) -> [f32; 16] {
    let placed = view.render_from_camera(view.shutter.interval().min);
    let [x, y, z] = placed.rows();
    let to_world = view.world_from_render.to_array();
    let row = |row: &[f32; 4], shift: f64| [row[0], row[1], row[2], (f64::from(row[3]) + shift) as f32];
    let [x, y, z] = [row(x, to_world[0]), row(y, to_world[1]), row(z, to_world[2])];
    let mut matrix = [0.0; 16];
    for (to, from) in matrix.iter_mut().zip([x, y, z, [0.0, 0.0, 0.0, 1.0]].concat()) {
        *to = from;
    }
    matrix
}
