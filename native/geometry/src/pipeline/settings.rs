//! What a user asks for.

use serde::{Deserialize, Serialize};

use super::Error;
use super::borders::Borders;
use super::handles::Handles;
use super::inner::Inner;
use super::mirror::Mirror;
use super::small::SmallParts;
use super::solid::SOLID_DETAIL;
use crate::elementary::powf;
use crate::{clean, flow, score};

/// The fewest faces that can be asked for: those of a tetrahedron.
pub const MIN_FACES: usize = 4;
/// The most faces that can be asked for.
pub const MAX_FACES: usize = 4_000_000;

/// The polygons of the new mesh.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Triangles.
    Triangles,
    /// Quads.
    #[default]
    Quads,
}

impl Kind {
    /// The name, as users write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Quads => "quads",
        }
    }

    /// The fewest faces of this kind that close a surface of genus 0.
    pub fn fewest_faces(self) -> usize {
        match self {
            Self::Triangles => 4,
            Self::Quads => 6,
        }
    }
}

/// The mesh of the sphere that is deformed into the new mesh.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Primitive {
    /// Triangles placed where the surface needs them.
    Adaptive,
    /// Quads whose edges follow the shape, with irregular vertices where the shape needs them.
    Flow,
    /// A subdivided box, blown up: quads with eight irregular vertices.
    QuadSphere,
    /// A subdivided icosahedron, blown up: triangles with twelve irregular vertices.
    Icosphere,
}

impl Primitive {
    /// The name, as users write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Adaptive => "adaptive",
            Self::Flow => "flow",
            Self::QuadSphere => "quad-sphere",
            Self::Icosphere => "icosphere",
        }
    }

    /// The polygons that the primitive has.
    pub fn kind(self) -> Kind {
        match self {
            Self::Adaptive | Self::Icosphere => Kind::Triangles,
            Self::Flow | Self::QuadSphere => Kind::Quads,
        }
    }
}

/// How quads flow, each from 0 to 1; the default is what most want.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default)]
pub struct Style {
    /// 0 for smooth loops, 1 for edges along the curvature wherever there is any.
    pub follow_shape: f64,
    /// 0 for quads of one size, 1 for much smaller ones where the surface is bent.
    pub adaptivity: f64,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            follow_shape: 0.5,
            adaptivity: 0.5,
        }
    }
}

/// From this adaptivity on nobody has asked for even quads.
const UNEVEN: f64 = 0.25;
/// How much more whole periods far from the wish cost where quads are to be even: what they are off
/// makes quads of other sizes. At 2 twice as many quads lie in spirals.
const NEARER: f64 = 1.0;

impl Style {
    /// How much edges wish for one length: 1 where there is to be but one size, 0 where sizes differ.
    pub(super) fn evenness(self) -> f64 {
        (1.0 - self.adaptivity / UNEVEN).max(0.0)
    }

    /// What the flow of so many quads is asked for.
    fn flow(self, n_quads: usize) -> flow::Settings {
        let mut settings = flow::Settings::new(n_quads);
        settings.field.alignment = 0.75 * powf(4.0_f64, self.follow_shape);
        settings.sizes.adaptivity = 2.0 * self.adaptivity;
        settings.search.weights.energy *= 1.0 + NEARER * self.evenness();
        settings
    }

    fn check(self) -> Result<(), Error> {
        let named = [
            ("follow shape", self.follow_shape),
            ("adaptivity", self.adaptivity),
        ];
        for (name, value) in named {
            if !(0.0..=1.0).contains(&value) {
                return Err(Error::StyleOutOfRange { name, value });
            }
        }
        Ok(())
    }
}

/// What a user asks for; the default is what most want.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// How many faces the new mesh should have, from 4 to 4,000,000. The count that is reached
    /// differs by less than 2 % from some 100 faces on, and is the nearest possible below.
    pub faces: usize,
    /// Triangles or quads.
    pub kind: Kind,
    /// The sphere that is deformed; none chooses adaptive triangles or flow.
    pub primitive: Option<Primitive>,
    /// How quads flow; nothing else asks for it.
    pub style: Style,
    /// Whether a part keeps its own quads, cut into finer ones or without some strips, where good ones
    /// come of it; else new ones are made.
    pub own_quads: bool,
    /// Edges at which the surface turns by more than so many degrees, from 0 to 180, get edges of
    /// the result along them; 180 keeps none but those that are marked.
    pub sharp_angle: f64,
    /// In which plane the quads that flow are each other's images; nothing else asks for it.
    pub mirror: Mirror,
    /// What becomes of parts that are too small.
    pub small_parts: SmallParts,
    /// Parts that measure less than so many percent of the whole mesh's diagonal are small; at 0
    /// only those are whose share of the faces is too few to close them.
    pub small_size: f64,
    /// Up to which gap borders that lie on each other are welded, as a share of the diagonal; none
    /// welds equal points alone.
    pub weld: Option<f64>,
    /// What becomes of borders.
    pub borders: Borders,
    /// What becomes of handles.
    pub handles: Handles,
    /// Whether everything becomes one closed surface first.
    pub solid: bool,
    /// The size of the cells of the grid that does it, in percent of the diagonal, from 0.02 to 5.
    pub solid_detail: f64,
    /// What becomes of closed parts that lie wholly inside another.
    pub inner: Inner,
    /// Whether a part that cannot be done, and is not merely small, ends the run.
    pub strict: bool,
    /// Where the adaptive primitive's samples start; equal seeds give equal bytes.
    pub seed: u64,
    /// How many threads to use; 0 uses every core. The result does not depend on it.
    pub threads: usize,
    /// How many crosses of the field to tell, at most; to be shown, the result does not depend on it.
    pub n_crosses: usize,
    /// How the result is scored; none saves the time. A score without a target takes the number
    /// of faces that was asked for.
    pub score: Option<score::Settings>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            faces: 2000,
            kind: Kind::Quads,
            primitive: None,
            style: Style::default(),
            own_quads: true,
            sharp_angle: 40.0,
            mirror: Mirror::default(),
            small_parts: SmallParts::default(),
            small_size: 0.0,
            weld: Some(clean::WELD),
            borders: Borders::default(),
            handles: Handles::default(),
            solid: false,
            solid_detail: SOLID_DETAIL,
            inner: Inner::default(),
            strict: false,
            seed: 0,
            threads: 0,
            n_crosses: 0,
            score: None,
        }
    }
}

impl Settings {
    /// The plane to look for: nothing but quads that flow can be each other's images.
    pub(super) fn mirror(&self) -> Mirror {
        match self.primitive() {
            Primitive::Flow => self.mirror,
            _ => Mirror::Off,
        }
    }

    /// Whether an axis is named for faces that cannot be each other's images.
    pub(super) fn mirrors_in_vain(&self) -> bool {
        !matches!(self.mirror, Mirror::Off | Mirror::Auto) && self.mirror() == Mirror::Off
    }

    /// The primitive that is asked for, or the one that suits the kind.
    pub fn primitive(&self) -> Primitive {
        self.primitive.unwrap_or(match self.kind {
            Kind::Triangles => Primitive::Adaptive,
            Kind::Quads => Primitive::Flow,
        })
    }

    /// What the flow of so many quads is asked for.
    pub(super) fn flow(&self, n_quads: usize) -> flow::Settings {
        flow::Settings {
            sharp_angle: Some(self.sharp_angle.to_radians()),
            ..self.style.flow(n_quads)
        }
    }

    /// How the result is scored, with the target in quads: two triangles count as one.
    pub(super) fn score(&self) -> Option<score::Settings> {
        let target = match self.kind {
            Kind::Triangles => self.faces.div_ceil(2),
            Kind::Quads => self.faces,
        };
        self.score.map(|wanted| score::Settings {
            target: wanted.target.or(Some(target)),
            ..wanted
        })
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        check_faces(self.faces)?;
        self.style.check()?;
        self.check_sizes()?;
        self.check_borders()?;
        self.check_handles()?;
        self.check_solid()?;
        let degrees = self.sharp_angle;
        if !(0.0..=180.0).contains(&degrees) {
            return Err(Error::AngleOutOfRange { degrees });
        }
        let primitive = self.primitive();
        if primitive.kind() == self.kind {
            return Ok(());
        }
        Err(Error::KindMismatch {
            primitive,
            kind: self.kind,
        })
    }
}

pub(super) fn check_faces(faces: usize) -> Result<(), Error> {
    if (MIN_FACES..=MAX_FACES).contains(&faces) {
        return Ok(());
    }
    Err(Error::FacesOutOfRange { faces })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn styles_go_from_0_to_1_and_the_default_is_the_flow_s() {
        assert_eq!(Settings::default().flow(700), flow::Settings::new(700));
        for adaptivity in [-0.1, 1.1, f64::NAN] {
            let style = Style {
                adaptivity,
                ..Style::default()
            };
            let settings = Settings {
                style,
                ..Settings::default()
            };
            let refused = matches!(settings.check(), Err(Error::StyleOutOfRange { .. }));
            assert!(refused, "{adaptivity}");
        }
    }

    #[test]
    fn edges_wish_for_one_length_and_periods_for_the_wish_where_there_is_to_be_one_size() {
        let evenness = |adaptivity| {
            let style = Style {
                adaptivity,
                ..Style::default()
            };
            let usual = flow::Settings::new(700).search.weights.energy;
            let energy = style.flow(700).search.weights.energy;
            [style.evenness(), energy / usual - 1.0]
        };
        for (adaptivity, wanted) in [(0.0, 1.0), (0.1, 0.6), (0.25, 0.0), (0.5, 0.0), (1.0, 0.0)] {
            let [wish, nearer] = evenness(adaptivity);
            assert!((wish - wanted).abs() < 1e-12, "{adaptivity}: {wish}");
            assert!(
                (nearer - NEARER * wanted).abs() < 1e-12,
                "{adaptivity}: {nearer}"
            );
        }
    }

    #[test]
    fn the_primitive_follows_the_kind_and_must_agree_with_it() {
        let mut settings = Settings {
            kind: Kind::Triangles,
            ..Settings::default()
        };
        assert_eq!(settings.primitive(), Primitive::Adaptive);
        assert!(settings.check().is_ok());
        settings.primitive = Some(Primitive::QuadSphere);
        let message = settings.check().unwrap_err().to_string();
        assert_eq!(
            message,
            "the quad-sphere primitive makes quads, but triangles were asked for"
        );
    }

    #[test]
    fn a_sharp_angle_out_of_range_is_refused() {
        for sharp_angle in [-1.0, 180.5, f64::NAN] {
            let settings = Settings {
                sharp_angle,
                ..Settings::default()
            };
            let refused = matches!(settings.check(), Err(Error::AngleOutOfRange { .. }));
            assert!(refused, "{sharp_angle}");
        }
    }

    #[test]
    fn counts_out_of_range_are_refused_with_the_range() {
        for faces in [0, 3, 4_000_001] {
            let settings = Settings {
                faces,
                ..Settings::default()
            };
            let message = settings.check().unwrap_err().to_string();
            assert_eq!(
                message,
                format!("{faces} faces were asked for; 4 to 4000000 can be made")
            );
        }
    }
}
