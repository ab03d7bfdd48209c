//! What questions are asked with: each type of argument says once how it crosses.

use super::crossing::{Element, Malformed, Part, Received, Request, Sent};
use super::work::{of_path, of_pixel};
use super::{
    AdaptiveSettings, Capabilities, Circumstances, IntegratorSettings, Primitive, Randomness,
    RenderSettings, Sampler,
};
use crate::scene::{Aabb, Camera, Material, Surface};
use glam::{DVec2, DVec3};

/// What a question is asked with.
pub trait Argument<'a>: Copy {
    /// What is kept of it at the other end, with the arrays of a body that lives for `'b`.
    type Kept<'b>;

    /// What of it crosses.
    const PARTS: &'static [Part];

    /// Puts it into a request.
    fn pack(self, name: &'static str, request: &mut Request<'a>);

    /// Takes it out again.
    ///
    /// # Errors
    /// If it is not there.
    fn keep<'b>(name: &str, received: &mut Received<'b>) -> Result<Self::Kept<'b>, Malformed>;

    /// As the core is handed it.
    fn lend<'b: 'a>(kept: &'a Self::Kept<'b>) -> Self;

    /// The size of the answer, if it says one: as in [`super::answer::Asked`].
    fn size(self) -> Option<[usize; 2]> {
        None
    }

    /// What each element of the answer takes because of it, in times of a ray that meets little.
    fn work(self) -> u64 {
        1
    }

    /// Under what it lets the core answer.
    fn circumstances(self) -> Circumstances {
        Circumstances::empty()
    }

    /// What a core needs to understand it: what is younger than the contract is not shown to cores that do not say
    /// that they know it.
    fn needs(self) -> Capabilities {
        Capabilities::empty()
    }
}

impl<'a> Request<'a> {
    /// Adds what a question is asked with.
    #[must_use]
    pub fn with_argument(mut self, name: &'static str, it: impl Argument<'a>) -> Self {
        it.pack(name, &mut self);
        self
    }
}

/// The size of the answer to a question with arguments of these sizes.
pub(crate) fn size_of_answer<const N: usize>(sizes: [Option<[usize; 2]>; N]) -> [usize; 2] {
    sizes.into_iter().flatten().next_back().unwrap_or([0, 1])
}

/// Members of the header.
macro_rules! members {
    ($($of:ty: $kept:ty, |$it:ident| $lent:expr $(, $method:ident = $by:path => $answer:ty)*;)*) => { $(
        impl<'a> Argument<'a> for $of {
            type Kept<'b> = $kept;
            const PARTS: &'static [Part] = &[Part::member("")];

            fn pack(self, name: &'static str, request: &mut Request<'a>) {
                request.member(name, self);
            }

            fn keep<'b>(name: &str, received: &mut Received<'b>) -> Result<$kept, Malformed> {
                received.member(name)
            }

            fn lend<'b: 'a>($it: &'a $kept) -> Self {
                $lent
            }

            $(fn $method(self) -> $answer {
                $by(self)
            })*
        }
    )* };
}
members! {
    u32: u32, |number| *number;
    f64: f64, |number| *number;
    Sampler: Sampler, |sampler| *sampler;
    &'a Camera: Camera, |camera| camera;
    &'a IntegratorSettings: IntegratorSettings, |settings| settings,
        work = of_path => u64, circumstances = Circumstances::of_path => Circumstances;
    &'a Material: Material, |material| material, needs = needed_by => Capabilities;
    &'a RenderSettings: RenderSettings, |settings| settings,
        size = size_of_picture => Option<[usize; 2]>, work = of_pixel => u64,
        circumstances = Circumstances::of_picture => Circumstances;
}

/// What a core has to know before it is shown a material.
pub(crate) fn needed_by(material: &Material) -> Capabilities {
    match material.surface {
        Surface::RoughGlass { .. } => Capabilities::ROUGH_GLASS,
        _ => Capabilities::empty(),
    }
}

fn size_of_picture(settings: &RenderSettings) -> Option<[usize; 2]> {
    Some([settings.width as usize, settings.height as usize])
}

/// Its fields are members themselves.
impl<'a> Argument<'a> for AdaptiveSettings {
    type Kept<'b> = Self;
    const PARTS: &'static [Part] =
        &[Part::member("samples-per-batch"), Part::member("max-tolerance")];

    fn pack(self, _: &'static str, request: &mut Request<'a>) {
        request.member("samples-per-batch", self.samples_per_batch);
        request.member("max-tolerance", self.max_tolerance);
    }

    fn keep<'b>(_: &str, received: &mut Received<'b>) -> Result<Self, Malformed> {
        let samples_per_batch = received.member("samples-per-batch")?;
        Ok(Self { samples_per_batch, max_tolerance: received.member("max-tolerance")? })
    }

    fn lend<'b: 'a>(kept: &'a Self) -> Self {
        *kept
    }
}

impl<'a, T: Element> Argument<'a> for &'a [T] {
    type Kept<'b> = &'b [T];
    const PARTS: &'static [Part] = &[Part::array::<T>("")];

    fn pack(self, name: &'static str, request: &mut Request<'a>) {
        request.arrays.push(Sent::new(name, self));
    }

    fn keep<'b>(name: &str, received: &mut Received<'b>) -> Result<&'b [T], Malformed> {
        received.take(name)
    }

    fn lend<'b: 'a>(kept: &'a &'b [T]) -> Self {
        kept
    }

    fn size(self) -> Option<[usize; 2]> {
        Some([self.len(), 1])
    }
}

impl<'a> Argument<'a> for Randomness<'a> {
    type Kept<'b> = Randomness<'b>;
    const PARTS: &'static [Part] =
        &[Part::member("seed"), Part::array::<DVec2>("points"), Part::array::<f64>("lobes")];

    fn pack(self, _: &'static str, request: &mut Request<'a>) {
        request.member("seed", self.seed);
        request.arrays.push(Sent::new("points", self.points));
        request.arrays.push(Sent::new("lobes", self.lobes));
    }

    fn keep<'b>(_: &str, received: &mut Received<'b>) -> Result<Randomness<'b>, Malformed> {
        let seed = received.member("seed")?;
        Ok(Randomness { points: received.take("points")?, lobes: received.take("lobes")?, seed })
    }

    fn lend<'b: 'a>(kept: &'a Randomness<'b>) -> Self {
        *kept
    }

    fn size(self) -> Option<[usize; 2]> {
        self.points.size()
    }
}

/// Streams cross one after another, and how long each is.
impl<'a> Argument<'a> for &'a [&'a [f64]] {
    type Kept<'b> = Vec<&'b [f64]>;
    const PARTS: &'static [Part] = &[Part::array::<f64>("values"), Part::array::<u64>("lengths")];

    fn pack(self, _: &'static str, request: &mut Request<'a>) {
        let lengths: Vec<_> = self.iter().map(|stream| stream.len() as u64).collect();
        request.arrays.push(Sent::made("values", &self.concat()));
        request.arrays.push(Sent::made("lengths", &lengths));
    }

    fn keep<'b>(_: &str, received: &mut Received<'b>) -> Result<Vec<&'b [f64]>, Malformed> {
        let mut values = received.take::<f64>("values")?;
        let lengths = received.take::<u64>("lengths")?;
        let too_few = || Malformed("streams longer than their values".to_owned());
        let mut streams = Vec::with_capacity(lengths.len());
        for length in lengths {
            let length = usize::try_from(*length).unwrap_or(usize::MAX);
            let (stream, rest) = values.split_at_checked(length).ok_or_else(too_few)?;
            streams.push(stream);
            values = rest;
        }
        Ok(streams)
    }

    fn lend<'b: 'a>(kept: &'a Vec<&'b [f64]>) -> Self {
        kept
    }

    fn size(self) -> Option<[usize; 2]> {
        Some([self.len(), 1])
    }
}

/// Either three corners with their normals, or a sphere; the request says which by its name.
impl<'a> Argument<'a> for &'a Primitive {
    type Kept<'b> = Primitive;
    const PARTS: &'static [Part] = &[
        Part::array::<DVec3>("positions"),
        Part::array::<DVec3>("normals"),
        Part::array::<[f64; 4]>("spheres"),
    ];

    fn pack(self, _: &'static str, request: &mut Request<'a>) {
        match self {
            Primitive::Triangle { positions, normals } => {
                request.member("request", "intersect-triangle");
                request.arrays.push(Sent::new("positions", positions).shared());
                request.arrays.push(Sent::new("normals", normals).shared());
            }
            Primitive::Sphere { centre, radius } => {
                request.member("request", "intersect-sphere");
                let sphere = [[centre.x, centre.y, centre.z, *radius]];
                request.arrays.push(Sent::made("spheres", &sphere).shared());
            }
        }
    }

    fn keep<'b>(_: &str, received: &mut Received<'b>) -> Result<Primitive, Malformed> {
        if received.name() == "intersect-sphere" {
            let [[x, y, z, radius]] = received.take_exactly("spheres")?;
            return Ok(Primitive::Sphere { centre: DVec3::new(x, y, z), radius });
        }
        let positions = received.take_exactly("positions")?;
        Ok(Primitive::Triangle { positions, normals: received.take_exactly("normals")? })
    }

    fn lend<'b: 'a>(kept: &'a Primitive) -> Self {
        kept
    }
}

/// Its smallest and its largest coordinates.
impl<'a> Argument<'a> for &'a Aabb {
    type Kept<'b> = Aabb;
    const PARTS: &'static [Part] = &[Part::array::<DVec3>("")];

    fn pack(self, name: &'static str, request: &mut Request<'a>) {
        request.arrays.push(Sent::made(name, &[self.min, self.max]).shared());
    }

    fn keep<'b>(name: &str, received: &mut Received<'b>) -> Result<Aabb, Malformed> {
        let [min, max] = received.take_exactly(name)?;
        Ok(Aabb { min, max })
    }

    fn lend<'b: 'a>(kept: &'a Aabb) -> Self {
        kept
    }
}
