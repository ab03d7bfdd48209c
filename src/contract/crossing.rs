//! How questions leave the process: their names, members of a JSON object, and arrays of plain elements.
//!
//! Not here: how each type of argument crosses ([`super::argument`]), the bytes of a frame, and whoever is at the other
//! end (`worker`). `docs/book/src/protocol.md` is this for people who write a core in another language.

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

/// A number or some numbers: what stands for "not written", and how it is in single precision.
pub trait Value: Copy {
    /// What no computation makes.
    const UNTOUCHED: Self;

    /// Rounded to single precision, if it has a fraction.
    #[must_use]
    fn rounded(self) -> Self;
}

impl Value for f64 {
    /// A NaN that no computation makes.
    const UNTOUCHED: Self = Self::from_bits(0x7ff8_f00d_f00d_f00d);

    fn rounded(self) -> Self {
        Self::from(self as f32)
    }
}

impl Value for f32 {
    const UNTOUCHED: Self = Self::from_bits(0x7fd0_f00d);

    fn rounded(self) -> Self {
        self
    }
}

/// Whole numbers are not rounded.
macro_rules! whole {
    ($($type:ty: $untouched:expr),*) => {
        $(impl Value for $type {
            const UNTOUCHED: Self = $untouched;

            fn rounded(self) -> Self {
                self
            }
        })*
    };
}
whole! { u8: u8::MAX, u32: u32::MAX - 1, u64: u64::MAX - 1 }

impl<T: Value, const N: usize> Value for [T; N] {
    const UNTOUCHED: Self = [T::UNTOUCHED; N];

    fn rounded(self) -> Self {
        self.map(T::rounded)
    }
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
        $(impl $crate::contract::crossing::Value for $type {
            const UNTOUCHED: Self = Self { $($field: $crate::contract::crossing::Value::UNTOUCHED),* };

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
    pub(super) arrays: Vec<Sent<'a>>,
}

impl<'a> Request<'a> {
    /// One of this name, in the words of the table of questions.
    pub fn new(name: &str) -> Self {
        let mut members = Map::new();
        members.insert("request".to_owned(), name.replace('_', "-").into());
        Self { members, arrays: Vec::new() }
    }

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

    /// The arrays that have an element for each of a batch of `count`; none if this is no batch.
    pub(crate) fn batch(&self, count: usize) -> Option<Vec<&Sent<'a>>> {
        let of_batch: Vec<_> = self.arrays.iter().filter(|array| !array.is_shared()).collect();
        let is_whole = of_batch.iter().all(|array| array.count() == count);
        (count > 0 && !of_batch.is_empty() && is_whole).then_some(of_batch)
    }

    /// One element of a batch of `count` in words: its numbers.
    pub(crate) fn describe(&self, index: usize, count: usize) -> Option<String> {
        Some(self.batch(count)?.first()?.describe(index))
    }

    #[must_use]
    pub(crate) fn with(mut self, name: &str, member: impl Serialize) -> Self {
        self.member(name, member);
        self
    }

    #[must_use]
    pub(crate) fn with_array(mut self, array: Sent<'a>) -> Self {
        self.arrays.push(array);
        self
    }

    /// The same with only some of the elements of each array that is not shared.
    #[must_use]
    pub(crate) fn part(&self, range: &Range<usize>) -> Request<'_> {
        let arrays = self.arrays.iter().map(|array| array.part(range)).collect();
        Request { members: self.members.clone(), arrays }
    }

    pub(super) fn member(&mut self, name: &str, member: impl Serialize) {
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
    pub(super) fn take_exactly<T: Element, const N: usize>(
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

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

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
