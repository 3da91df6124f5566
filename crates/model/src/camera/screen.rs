//! The window of the image plane that the film shows.
use durer_core::math::{Point2, Vector3, float::lerp};
use durer_scene::{Args, ParamDefault, ParamSpec, ParamType};

/// Which side of the default window runs from -1 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum UnitAxis {
    Shorter,
    X,
    Y,
}

/// A window `[x_min, x_max] x [y_min, y_max]` of the image plane, x right and y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Screen {
    /// As given by the scene, if it is.
    fixed: Option<[f32; 4]>,
    aspect: Option<f32>,
    unit_axis: UnitAxis,
    window: [f32; 4],
}

pub(super) const SCREEN_WINDOW: ParamSpec = ParamSpec::new(
    "screenwindow",
    ParamType::Floats,
    ParamDefault::Unset,
    "Four numbers xmin xmax ymin ymax: the part of the image plane shown. Default: the axis that fov measures from -1 to \
     1, the other as the picture's aspect ratio asks.",
);
pub(super) const ASPECT: ParamSpec = ParamSpec::new(
    "frameaspectratio",
    ParamType::Float,
    ParamDefault::Unset,
    "Width by height of the default window; default: that of the picture.",
)
.above(0.0, f32::INFINITY);

impl Screen {
    /// From the two parameters above.
    pub(super) fn read(args: &mut Args<'_>, unit_axis: UnitAxis) -> Self {
        let fixed = match *args.floats("screenwindow") {
            [] => None,
            [x0, x1, y0, y1] => {
                if x0 == x1 || y0 == y1 {
                    args.error("screenwindow", "\"screenwindow\" is empty: xmin = xmax or ymin = ymax");
                }
                Some([x0, x1, y0, y1])
            }
            ref other => {
                args.error(
                    "screenwindow",
                    format!("\"screenwindow\" has {} values, expected 4", other.len()),
                );
                None
            }
        };
        let aspect = args.optional_float("frameaspectratio");
        let mut screen = Self { fixed, aspect, unit_axis, window: [0.0; 4] };
        screen.fit(1, 1);
        screen
    }
    /// Adapts the window to a picture of this many pixels.
    pub(super) fn fit(&mut self, width: u32, height: u32) {
        let aspect = self.aspect.unwrap_or(width.max(1) as f32 / height.max(1) as f32);
        let is_y_unit = match self.unit_axis {
            UnitAxis::Shorter => aspect > 1.0,
            UnitAxis::X => false,
            UnitAxis::Y => true,
        };
        let (x, y) = if is_y_unit { (aspect, 1.0) } else { (1.0, 1.0 / aspect) };
        self.window = self.fixed.unwrap_or([-x, x, -y, y]);
    }
    /// Half the height of the window.
    pub(super) fn half_height(&self) -> f32 {
        (self.window[3] - self.window[2]).abs() * 0.5
    }
    /// What steps over the whole film, to the right and down, are on the image plane.
    pub(super) fn steps(&self) -> [Vector3; 2] {
        let [x_min, x_max, y_min, y_max] = self.window;
        [Vector3::new(x_max - x_min, 0.0, 0.0), Vector3::new(0.0, y_min - y_max, 0.0)]
    }
    /// The point of the image plane at a film position (x right, y down, in `[0, 1]`).
    pub(super) fn at(&self, film: Point2) -> Point2 {
        let [x_min, x_max, y_min, y_max] = self.window;
        Point2::new(lerp(film.x, x_min, x_max), lerp(film.y, y_max, y_min))
    }
    /// The film position of a point of the image plane.
    pub(super) fn film(&self, at: Point2) -> Point2 {
        let [x_min, x_max, y_min, y_max] = self.window;
        Point2::new((at.x - x_min) / (x_max - x_min), (at.y - y_max) / (y_min - y_max))
    }
    /// Area of the window.
    pub(super) fn area(&self) -> f32 {
        let [x_min, x_max, y_min, y_max] = self.window;
        ((x_max - x_min) * (y_max - y_min)).abs()
    }
}
