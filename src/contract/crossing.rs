//! How questions leave the process: their names, members of a JSON object, and arrays of plain elements.
//!
//! Each type of argument says once how it crosses ([`Argument`]). Not here: the bytes of a frame, and whoever is at
//! the other end (`worker`). `docs/protocol.md` is this for people who write a core in another language.

use super::answer::Value;
use super::{
    AdaptiveSettings, Capabilities, IntegratorSettings, Primitive, Randomness, RenderSettings,
    Sampler,
};
use crate::scene::{Aabb, Camera, Material, Surface};
use bytemuck::Pod;
use glam::{DVec2, DVec3};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};
use std::borrow::Cow;
use std::ops::{Deref, Range};

/// What came is not what it says it is.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Malformed(pub String);

/// What of an argument or an answer crosses.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its name; that of the argument or the answer where this is empty.
    pub name: &'static str,
    /// What the array is made of; none of a member of the header.
    pub element: Option<Layout>,
}

impl Part {
    /// A member of the header.
    pub(crate) const fn member(name: &'static str) -> Self {
        Self { name, element: None }
    }

    /// An array of `T`.
    pub(crate) const fn array<T: Element>(name: &'static str) -> Self {
        Self { name, element: Some(T::LAYOUT) }
    }
}

/// How an element lies in memory, on both sides.
#[derive(Clone, Copy, Debug)]
pub struct Layout {
    /// What the protocol calls it.
    pub name: &'static str,
    /// Its bytes.
    pub size: usize,
    /// Its fields and where they begin, if they have names.
    pub fields: &'static [(&'static str, usize)],
}

/// An element of arrays: the same bytes on both sides.
pub trait Element: Pod + Value {
    /// How it lies in memory.
    const LAYOUT: Layout;
}

/// Elements by their names in the protocol. One with named fields is untouched where each of them is.
macro_rules! elements {
    ($($name:literal: $type:ty $({ $($field:ident),* })?;)*) => { $(
        impl $crate::contract::crossing::Element for $type {
            const LAYOUT: $crate::contract::crossing::Layout = $crate::contract::crossing::Layout {
                name: $name,
                size: size_of::<$type>(),
                fields: &[$($((stringify!($field), std::mem::offset_of!($type, $field))),*)?],
            };
        }
        $(impl $crate::contract::answer::Value for $type {
            const UNTOUCHED: Self = Self { $($field: $crate::contract::answer::Value::UNTOUCHED),* };

            fn rounded(self) -> Self {
                Self { $($field: self.$field.rounded()),* }
            }
        })?
    )* };
}
pub(crate) use elements;

elements! {
    "u8": u8;
    "u32": u32;
    "u64": u64;
    "f64": f64;
    "vec2": DVec2 { x, y };
    "vec3": DVec3 { x, y, z };
    "rgb": [f64; 3];
    "rgb-f32": [f32; 3];
    "rgb-u8": [u8; 3];
    "triangle": [u32; 3];
    "sphere": [f64; 4];
    "sphere-kind": [u32; 2];
}

/// A question on its way.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    members: Map<String, Json>,
    arrays: Vec<Sent<'a>>,
}

impl<'a> Request<'a> {
    /// One of this name, in the words of the table of questions.
    pub fn new(name: &str) -> Self {
        let mut members = Map::new();
        members.insert("request".to_owned(), name.replace('_', "-").into());
        Self { members, arrays: Vec::new() }
    }

    /// What it is called.
    pub(crate) fn name(&self) -> &str {
        self.members["request"].as_str().unwrap_or_default()
    }

    /// The header but for the list of arrays.
    pub const fn members(&self) -> &Map<String, Json> {
        &self.members
    }

    /// What goes along.
    pub fn arrays(&self) -> &[Sent<'a>] {
        &self.arrays
    }

    /// Adds a member.
    #[must_use]
    pub(crate) fn with(mut self, name: &str, member: impl Serialize) -> Self {
        self.member(name, member);
        self
    }

    /// Adds an array.
    #[must_use]
    pub(crate) fn with_array(mut self, array: Sent<'a>) -> Self {
        self.arrays.push(array);
        self
    }

    /// Adds what a question is asked with.
    #[must_use]
    pub fn with_argument(mut self, name: &'static str, it: impl Argument<'a>) -> Self {
        it.pack(name, &mut self);
        self
    }

    /// The same with only some of the elements of each array that is not shared.
    #[must_use]
    pub(crate) fn part(&self, range: &Range<usize>) -> Request<'_> {
        let arrays = self.arrays.iter().map(|array| array.part(range)).collect();
        Request { members: self.members.clone(), arrays }
    }

    fn member(&mut self, name: &str, member: impl Serialize) {
        // What crosses are plain structs, which are always JSON.
        self.members.insert(name.to_owned(), serde_json::to_value(member).unwrap_or_default());
    }
}

/// A question that has come.
#[derive(Debug)]
pub struct Received<'a> {
    members: Map<String, Json>,
    headers: Vec<ArrayHeader>,
    taken: usize,
    bytes: &'a [u8],
}

impl<'a> Received<'a> {
    /// With this header and body.
    ///
    /// # Errors
    /// If the list of arrays is none.
    pub(crate) fn new(mut members: Map<String, Json>, body: &'a [u8]) -> Result<Self, Malformed> {
        let arrays = members.remove("arrays").unwrap_or_else(|| Json::Array(Vec::new()));
        let headers = from_json("arrays", arrays)?;
        Ok(Self { members, headers, taken: 0, bytes: body })
    }

    /// What it is called.
    pub(crate) fn name(&self) -> &str {
        self.members.get("request").and_then(Json::as_str).unwrap_or_default()
    }

    /// Whether it asks what the table of questions calls `method`.
    pub(crate) fn asks(&self, method: &str) -> bool {
        let name = match self.name() {
            "intersect-triangle" | "intersect-sphere" => "intersect-primitive",
            name => name,
        };
        name == method.replace('_', "-")
    }

    /// A member of the header.
    ///
    /// # Errors
    /// If it is missing, or something else.
    pub(crate) fn member<T: DeserializeOwned>(&mut self, name: &str) -> Result<T, Malformed> {
        let member = self.members.remove(name);
        from_json(name, member.ok_or_else(|| Malformed(format!("member `{name}` is missing")))?)
    }

    /// The next array, which has this name.
    ///
    /// # Errors
    /// If it is another, or longer than what was sent.
    pub(crate) fn take<T: Element>(&mut self, name: &str) -> Result<&'a [T], Malformed> {
        let wrong = |what: String| Malformed(format!("array `{name}` {what}"));
        let header = self.headers.get(self.taken).ok_or_else(|| wrong("is missing".to_owned()))?;
        self.taken += 1;
        let ArrayHeader(found, element, count) = header;
        if (found.as_str(), element.as_str()) != (name, T::LAYOUT.name) {
            return Err(wrong(format!("is `{found}` of {element}, not of {}", T::LAYOUT.name)));
        }
        let size = usize::try_from(*count).ok().and_then(|n| n.checked_mul(size_of::<T>()));
        let end = size.filter(|size| *size <= self.bytes.len());
        let end =
            end.ok_or_else(|| wrong(format!("has {count} elements, and not so many came")))?;
        let (array, _) = self.bytes.split_at(end);
        self.bytes = &self.bytes[padded(end).min(self.bytes.len())..];
        bytemuck::try_cast_slice(array).map_err(|error| wrong(error.to_string()))
    }

    /// The next array, which has this name and just so many elements.
    fn take_exactly<T: Element, const N: usize>(
        &mut self,
        name: &str,
    ) -> Result<[T; N], Malformed> {
        let array = self.take(name)?;
        let other = |_| Malformed(format!("array `{name}` has {} elements", array.len()));
        <[T; N]>::try_from(array).map_err(other)
    }
}

fn from_json<T: DeserializeOwned>(name: &str, json: Json) -> Result<T, Malformed> {
    serde_json::from_value(json).map_err(|error| Malformed(format!("member `{name}`: {error}")))
}

/// Every array begins at a multiple of this many bytes.
pub(crate) const ALIGNMENT: usize = 8;

/// How many bytes an array of so many takes in the body.
pub(crate) const fn padded(bytes: usize) -> usize {
    bytes.next_multiple_of(ALIGNMENT)
}

/// One array: what it is called, what each element is, how many there are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ArrayHeader(pub(crate) String, pub(crate) String, pub(crate) u64);

/// An array on its way.
#[derive(Clone, Debug)]
pub struct Array<B> {
    name: &'static str,
    element: &'static str,
    count: usize,
    bytes: B,
    /// Whether each element of the batch needs all of it.
    shared: bool,
}

/// An array that is sent.
pub type Sent<'a> = Array<Cow<'a, [u8]>>;

/// An array that is to be filled by an answer.
pub type Wanted<'a> = Array<&'a mut [u8]>;

impl<B: Deref<Target = [u8]>> Array<B> {
    fn of<T: Element>(name: &'static str, bytes: B) -> Self {
        let count = bytes.len() / size_of::<T>();
        Self { name, element: T::LAYOUT.name, count, bytes, shared: false }
    }

    /// Its line in the header.
    pub(crate) fn header(&self) -> ArrayHeader {
        ArrayHeader(self.name.replace('_', "-"), self.element.to_owned(), self.count as u64)
    }

    /// Its bytes.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// How many elements there are.
    pub(crate) const fn count(&self) -> usize {
        self.count
    }

    /// The bytes of one element.
    pub(crate) fn size_of_one(&self) -> usize {
        (self.bytes.len() / self.count.max(1)).max(1)
    }

    /// The same array in other memory, with as many of its elements as that holds.
    pub(crate) fn within<C: Deref<Target = [u8]>>(&self, bytes: C) -> Array<C> {
        let count = bytes.len() / self.size_of_one();
        Array { name: self.name, element: self.element, count, bytes, shared: self.shared }
    }
}

impl<'a> Sent<'a> {
    /// `elements`, called `name`.
    pub fn new<T: Element>(name: &'static str, elements: &'a [T]) -> Self {
        Self::of::<T>(name, Cow::Borrowed(bytemuck::cast_slice(elements)))
    }

    /// Elements that are made for the sending.
    pub(crate) fn made<T: Element>(name: &'static str, elements: &[T]) -> Self {
        Self::of::<T>(name, Cow::Owned(bytemuck::cast_slice(elements).to_vec()))
    }

    /// The same, to go with every part of a batch: the corners of the triangle that rays meet.
    /// Numbers that may be NaN or infinite travel so, since JSON has none.
    #[must_use]
    pub(crate) fn shared(self) -> Self {
        Self { shared: true, ..self }
    }

    /// Whether each element of the batch needs all of it.
    pub(crate) const fn is_shared(&self) -> bool {
        self.shared
    }

    /// Some of its elements; all of them, if they are shared.
    pub(crate) fn part(&self, range: &Range<usize>) -> Sent<'_> {
        let size = self.size_of_one();
        let bytes = match self.shared {
            true => self.bytes(),
            false => &self.bytes[range.start * size..range.end * size],
        };
        self.within(Cow::Borrowed(bytes))
    }

    /// One element in words: its numbers.
    pub(crate) fn describe(&self, index: usize) -> String {
        let part = self.part(&(index..index + 1));
        let Ok(numbers) = bytemuck::try_cast_slice::<u8, f64>(part.bytes()) else {
            return format!("{:?}", part.bytes());
        };
        match (self.element, numbers) {
            ("ray", [ox, oy, oz, t_min, dx, dy, dz, t_max]) => format!(
                "origin [{ox}, {oy}, {oz}], direction [{dx}, {dy}, {dz}], t from {t_min} to {t_max}"
            ),
            _ => format!("{} {numbers:?}", self.name),
        }
    }
}

impl<'a> Wanted<'a> {
    /// `elements`, called `name`.
    pub fn new<T: Element>(name: &'static str, elements: &'a mut [T]) -> Self {
        Self::of::<T>(name, bytemuck::cast_slice_mut(elements))
    }

    /// Where its bytes go.
    pub(crate) fn bytes_mut(&mut self) -> &mut [u8] {
        self.bytes
    }
}

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

    /// What a core needs to understand it: what is younger than the contract is not shown to cores that do not say
    /// that they know it.
    fn needs(self) -> Capabilities {
        Capabilities::empty()
    }
}

/// The size of the answer to a question with arguments of these sizes.
pub(crate) fn size_of_answer<const N: usize>(sizes: [Option<[usize; 2]>; N]) -> [usize; 2] {
    sizes.into_iter().flatten().next_back().unwrap_or([0, 1])
}

/// Members of the header.
macro_rules! members {
    ($($of:ty: $kept:ty, |$it:ident| $lent:expr $(, $method:ident = $by:path => $answer:ty)?;)*) => { $(
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
            })?
        }
    )* };
}
members! {
    u32: u32, |number| *number;
    f64: f64, |number| *number;
    Sampler: Sampler, |sampler| *sampler;
    &'a Camera: Camera, |camera| camera;
    &'a IntegratorSettings: IntegratorSettings, |settings| settings;
    &'a Material: Material, |material| material, needs = needed_by => Capabilities;
    &'a RenderSettings: RenderSettings, |settings| settings,
        size = size_of_picture => Option<[usize; 2]>;
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
