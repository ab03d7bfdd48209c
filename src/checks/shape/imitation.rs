//! Ray-primitive intersection, right and wrong: what a core answers if it has made one of the usual mistakes.
//!
//! A mistake is named only if it predicts every answer of a core, the right ones among them.

use crate::cause::{Cause, shape};
use crate::checks::few::{Few, few_that_fit};
use crate::checks::phrase::figure;
use crate::contract::{Hit, Primitive, Ray};
use glam::DVec3;

/// What there is to say of a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Answer {
    /// Ray parameter in units of `|direction|`.
    pub(crate) t: f64,
    /// Unit, on the side of the winding; outward for a sphere.
    pub(crate) geometric_normal: DVec3,
    /// Unit, interpolated.
    pub(crate) shading_normal: DVec3,
    /// Weights of the three vertices; `None` for a sphere.
    pub(crate) weights: Option<[f64; 3]>,
}

impl Answer {
    /// A hit of a sphere, which is not divided into vertices.
    #[cfg(test)]
    pub(crate) const fn of_sphere(t: f64, normal: DVec3) -> Self {
        Self { t, geometric_normal: normal, shading_normal: normal, weights: None }
    }

    /// With one normal in place of both.
    #[cfg(test)]
    pub(crate) const fn with_normal(self, normal: DVec3) -> Self {
        Self { geometric_normal: normal, shading_normal: normal, ..self }
    }

    /// With both normals times `sign`.
    pub(crate) fn turned(self, sign: f64) -> Self {
        Self {
            geometric_normal: sign * self.geometric_normal,
            shading_normal: sign * self.shading_normal,
            ..self
        }
    }

    /// As a case would write it: `t = 1, normal = [0, 0, 1], shading-normal = [0, 0, 1]`.
    pub(crate) fn in_words(&self) -> String {
        let [normal, shading] = [self.geometric_normal, self.shading_normal]
            .map(|n| n.to_array().map(figure).join(", "));
        let known = format!("t = {}, normal = [{normal}], shading-normal = [{shading}]", self.t);
        match self.weights {
            None => known,
            Some(w) => format!("{known}, barycentric = [{}]", w.map(figure).join(", ")),
        }
    }

    /// Whether a core gave this answer, to within `allowed` (relative for t).
    pub(crate) fn is_like(&self, hit: &Hit, allowed: f64) -> bool {
        let weights = self.weights.is_none_or(|[_, v, w]| {
            (hit.uv.x - v).abs() <= allowed && (hit.uv.y - w).abs() <= allowed
        });
        weights
            && (hit.t - self.t).abs() <= allowed * self.t.abs()
            && hit.geometric_normal.distance(self.geometric_normal) <= allowed
            && hit.shading_normal.distance(self.shading_normal) <= allowed
    }
}

/// An implementation of ray-primitive intersection.
#[cfg(test)]
pub(crate) type Formula = fn(&Primitive, &Ray) -> Option<Answer>;

/// The right one: the first meeting point inside the primitive and inside the open segment.
pub(crate) fn intersection(primitive: &Primitive, ray: &Ray) -> Option<Answer> {
    Intersection::RIGHT.answer(primitive, ray)
}

fn is_on(ray: &Ray, t: f64) -> bool {
    ray.t_min < t && t < ray.t_max
}

/// A point in which the whole line of a ray meets the sphere or the plane of the triangle.
#[derive(Clone, Copy)]
pub(crate) struct Meeting {
    t: f64,
    /// Barycentric weights, negative outside; (1, 0, 0) on a sphere.
    weights: [f64; 3],
    geometric: DVec3,
    vertex_normals: [DVec3; 3],
    on_triangle: bool,
}

impl Meeting {
    const fn of_sphere(t: f64, normal: DVec3) -> Self {
        let (weights, vertex_normals) = ([1.0, 0.0, 0.0], [normal; 3]);
        Self { t, weights, geometric: normal, vertex_normals, on_triangle: false }
    }

    fn is_inside(&self) -> bool {
        self.weights.iter().all(|weight| *weight >= 0.0)
    }

    fn is_hit(&self, ray: &Ray) -> bool {
        self.is_inside() && is_on(ray, self.t)
    }

    fn interpolated(&self, weights: [f64; 3]) -> DVec3 {
        let sum: DVec3 = (0..3).map(|vertex| weights[vertex] * self.vertex_normals[vertex]).sum();
        sum.normalize_or_zero()
    }

    fn answer(self) -> Answer {
        Answer {
            t: self.t,
            geometric_normal: self.geometric,
            shading_normal: self.interpolated(self.weights),
            weights: self.on_triangle.then_some(self.weights),
        }
    }
}

/// In order of t: none, one (triangle) or two (sphere).
fn meetings(primitive: &Primitive, ray: &Ray) -> Vec<Meeting> {
    match primitive {
        Primitive::Triangle { positions, normals } => {
            plane_meeting(positions, normals, ray).into_iter().collect()
        }
        Primitive::Sphere { centre, radius } => sphere_meetings(*centre, *radius, ray),
    }
}

/// Cramer's rule for o + t d = p0 + v e1 + w e2, after Möller and Trumbore (1997).
fn plane_meeting(positions: &[DVec3; 3], normals: &[DVec3; 3], ray: &Ray) -> Option<Meeting> {
    let (e1, e2) = (positions[1] - positions[0], positions[2] - positions[0]);
    let from_first = ray.origin - positions[0];
    let determinant = e1.dot(ray.direction.cross(e2));
    if determinant == 0.0 {
        return None;
    }
    let v = from_first.dot(ray.direction.cross(e2)) / determinant;
    let w = ray.direction.dot(from_first.cross(e1)) / determinant;
    Some(Meeting {
        t: e2.dot(from_first.cross(e1)) / determinant,
        weights: [1.0 - v - w, v, w],
        geometric: e1.cross(e2).normalize(),
        vertex_normals: *normals,
        on_triangle: true,
    })
}

fn sphere_meetings(centre: DVec3, radius: f64, ray: &Ray) -> Vec<Meeting> {
    let from_centre = ray.origin - centre;
    let a = ray.direction.length_squared();
    let half_b = from_centre.dot(ray.direction);
    let discriminant = half_b * half_b - a * (from_centre.length_squared() - radius * radius);
    if discriminant < 0.0 {
        return Vec::new();
    }
    let meeting = |sign: f64| {
        let t = (-half_b + sign * discriminant.sqrt()) / a;
        Meeting::of_sphere(t, (ray.at(t) - centre) / radius)
    };
    vec![meeting(-1.0), meeting(1.0)]
}

/// The mistakes that predict every one of these answers: `hits[i]` to `rays[i]`. A core that hits nothing has said nothing:
/// whatever makes nonsense of this primitive predicts it.
pub(crate) fn explanations(
    primitive: &Primitive,
    rays: &[Ray],
    hits: &[Hit],
    allowed: f64,
) -> Few<&'static Cause> {
    if !hits.iter().any(Hit::is_hit) {
        return Few::OneOf(Vec::new());
    }
    let predict = |made: &[&(&'static Cause, Made)]| {
        let formula = made.iter().fold(Intersection::RIGHT, |right, (_, made)| right.with(*made));
        rays.iter().zip(hits).all(|(ray, hit)| match formula.answer(primitive, ray) {
            Some(answer) => hit.is_hit() && answer.is_like(hit, allowed),
            None => !hit.is_hit(),
        })
    };
    few_that_fit(MISTAKES, predict).map(|(cause, _)| *cause)
}

/// Which meeting is taken for the hit.
type Finds = fn(&Primitive, &Ray) -> Option<Meeting>;
/// What is said of it.
type Describes = fn(&Ray, Meeting) -> Answer;

/// Intersection in two steps.
#[derive(Clone, Copy)]
pub(crate) struct Intersection {
    finds: Finds,
    describes: Describes,
}

impl Intersection {
    pub(crate) const RIGHT: Self =
        Self { finds: |p, ray| first(p, ray, |m| m.is_hit(ray)), describes: |_, m| m.answer() };

    /// The same with a mistake in it.
    pub(crate) fn with(self, made: Made) -> Self {
        match made {
            Made::Finds(finds) => Self { finds, ..self },
            Made::Describes(describes) => Self { describes, ..self },
        }
    }

    pub(crate) fn answer(&self, primitive: &Primitive, ray: &Ray) -> Option<Answer> {
        (self.finds)(primitive, ray).map(|meeting| (self.describes)(ray, meeting))
    }
}

/// A step that people write otherwise.
#[derive(Clone, Copy)]
pub(crate) enum Made {
    Finds(Finds),
    Describes(Describes),
}

/// Accepts a meeting by another rule.
fn first(primitive: &Primitive, ray: &Ray, accept: impl Fn(&Meeting) -> bool) -> Option<Meeting> {
    meetings(primitive, ray).into_iter().find(accept)
}

/// With the shading normal interpolated by other weights, which are handed over too.
fn shaded(meeting: Meeting, order: [usize; 3]) -> Answer {
    let weights = order.map(|vertex| meeting.weights[vertex]);
    let shading_normal = meeting.interpolated(weights);
    Answer { shading_normal, weights: Some(weights), ..meeting.answer() }
}

/// The same where only the normal is interpolated wrongly, and the weights handed over are right.
fn shaded_alone(meeting: Meeting, order: [usize; 3]) -> Answer {
    let shading_normal = meeting.interpolated(order.map(|vertex| meeting.weights[vertex]));
    Answer { shading_normal, ..meeting.answer() }
}

/// At the first of these t on the segment; the normal is that of the point there.
fn at_first(
    primitive: &Primitive,
    ray: &Ray,
    mut roots: impl Iterator<Item = f64>,
) -> Option<Meeting> {
    let Primitive::Sphere { centre, .. } = primitive else { return None };
    let t = roots.find(|t| is_on(ray, *t))?;
    Some(Meeting::of_sphere(t, (ray.at(t) - *centre).normalize_or_zero()))
}

/// The hit, and where the line of the ray meets the primitive first.
fn hit_and_first(primitive: &Primitive, ray: &Ray) -> Option<(Meeting, Meeting)> {
    let all = meetings(primitive, ray);
    let hit = all.iter().find(|m| m.is_hit(ray))?;
    Some((*hit, *all.first()?))
}

/// Steps that people write otherwise: what was done, and what it finds or says.
pub(super) const MISTAKES: &[(&Cause, Made)] = &[
    (
        &shape::SEGMENT_END_IGNORED,
        Made::Finds(|p, ray| first(p, ray, |m| m.is_inside() && ray.t_min < m.t)),
    ),
    (
        &shape::SEGMENT_START_IGNORED,
        Made::Finds(|p, ray| first(p, ray, |m| m.is_inside() && m.t < ray.t_max && m.t > 0.0)),
    ),
    (&shape::SEGMENT_IGNORED, Made::Finds(|p, ray| first(p, ray, Meeting::is_inside))),
    (
        &shape::HITS_BEHIND_ORIGIN,
        Made::Finds(|p, ray| first(p, ray, |m| m.is_inside() && m.t < ray.t_max)),
    ),
    (
        &shape::BOTH_ROOTS_REQUIRED,
        Made::Finds(|p, ray| {
            let all = meetings(p, ray);
            all.first().filter(|_| all.iter().all(|m| m.is_hit(ray))).copied()
        }),
    ),
    (
        &shape::FIRST_ROOT_UNCHECKED,
        Made::Finds(|p, ray| {
            let all = meetings(p, ray);
            all.first().filter(|_| all.iter().any(|m| m.is_hit(ray))).copied()
        }),
    ),
    (
        &shape::QUADRATIC_PRECEDENCE,
        Made::Finds(|p, ray| {
            let a = ray.direction.length_squared();
            at_first(p, ray, meetings(p, ray).into_iter().map(|m| m.t * a * a))
        }),
    ),
    (
        &shape::NEAR_ROOT_ONLY,
        Made::Finds(|p, ray| meetings(p, ray).first().filter(|m| m.is_hit(ray)).copied()),
    ),
    (
        &shape::FAR_ROOT_TAKEN,
        Made::Finds(|p, ray| meetings(p, ray).last().filter(|m| m.is_hit(ray)).copied()),
    ),
    (
        &shape::QUADRATIC_WITHOUT_A,
        Made::Finds(|p, ray| {
            let Primitive::Sphere { centre, radius } = p else { return None };
            let from_centre = ray.origin - *centre;
            let half_b = from_centre.dot(ray.direction);
            let c = from_centre.length_squared() - radius * radius;
            let root = (half_b * half_b - c).sqrt();
            at_first(p, ray, [-half_b - root, -half_b + root].into_iter())
        }),
    ),
    (
        &shape::QUADRATIC_DIVIDES_BY_A,
        Made::Finds(|p, ray| at_first(p, ray, meetings(p, ray).into_iter().map(|m| 2.0 * m.t))),
    ),
    (
        &shape::T_IN_SCENE_UNITS,
        Made::Finds(|p, ray| {
            let length = ray.direction.length();
            at_first(p, ray, meetings(p, ray).into_iter().map(|m| m.t * length))
        }),
    ),
    (
        &shape::MISSED_IF_CENTRE_BEHIND,
        Made::Finds(|p, ray| {
            let Primitive::Sphere { centre, .. } = p else {
                return first(p, ray, |m| m.is_hit(ray));
            };
            let is_ahead = (*centre - ray.origin).dot(ray.direction) >= 0.0;
            first(p, ray, |m| m.is_hit(ray) && is_ahead)
        }),
    ),
    (
        &shape::T_IN_SCENE_UNITS,
        Made::Describes(|ray, m| Answer { t: m.t * ray.direction.length(), ..m.answer() }),
    ),
    (
        &shape::PARALLELOGRAM,
        Made::Finds(|p, ray| {
            first(p, ray, |m| m.weights[1] >= 0.0 && m.weights[2] >= 0.0 && is_on(ray, m.t))
        }),
    ),
    (&shape::WHOLE_PLANE_HIT, Made::Finds(|p, ray| first(p, ray, |m| is_on(ray, m.t)))),
    (
        &shape::BACK_CULLED,
        Made::Finds(|p, ray| {
            first(p, ray, |m| m.is_hit(ray) && m.geometric.dot(ray.direction) < 0.0)
        }),
    ),
    (&shape::BARYCENTRICS_SWAPPED, Made::Describes(|_, m| shaded(m, [0, 2, 1]))),
    (&shape::NORMALS_SWAPPED, Made::Describes(|_, m| shaded_alone(m, [0, 2, 1]))),
    (&shape::BARYCENTRICS_MOVED_ON, Made::Describes(|_, m| shaded(m, [1, 2, 0]))),
    (&shape::NORMALS_MOVED_ON, Made::Describes(|_, m| shaded_alone(m, [1, 2, 0]))),
    (&shape::BARYCENTRICS_MOVED_BACK, Made::Describes(|_, m| shaded(m, [2, 0, 1]))),
    (&shape::NORMALS_MOVED_BACK, Made::Describes(|_, m| shaded_alone(m, [2, 0, 1]))),
    (
        &shape::FLAT_SHADING_NORMAL,
        Made::Describes(|_, m| Answer { shading_normal: m.geometric, ..m.answer() }),
    ),
    (
        &shape::GEOMETRIC_NORMAL_INTERPOLATED,
        Made::Describes(|_, m| {
            let answer = m.answer();
            Answer { geometric_normal: answer.shading_normal, ..answer }
        }),
    ),
    (
        &shape::NORMALS_FACE_RAY,
        Made::Describes(|ray, m| m.answer().turned(-m.geometric.dot(ray.direction).signum())),
    ),
    (
        &shape::NORMAL_AT_OTHER_ROOT,
        Made::Finds(|p, ray| {
            let (hit, Meeting { geometric, vertex_normals, .. }) = hit_and_first(p, ray)?;
            Some(Meeting { geometric, vertex_normals, ..hit })
        }),
    ),
    (
        &shape::NORMAL_AT_OTHER_ROOT,
        Made::Finds(|p, ray| {
            let (hit, Meeting { vertex_normals, .. }) = hit_and_first(p, ray)?;
            Some(Meeting { vertex_normals, ..hit })
        }),
    ),
    (&shape::NORMALS_INSIDE_OUT, Made::Describes(|_, m| m.answer().turned(-1.0))),
];

/// The answer as a core would give it.
#[cfg(test)]
pub(crate) fn as_hit(answer: Option<Answer>) -> Hit {
    answer.map_or(Hit::MISS, |answer| {
        let [_, v, w] = answer.weights.unwrap_or_default();
        Hit {
            t: answer.t,
            shape: 0,
            primitive: 0,
            geometric_normal: answer.geometric_normal,
            shading_normal: answer.shading_normal,
            uv: glam::DVec2::new(v, w),
        }
    })
}

/// The formula of a mistake that has one.
#[cfg(test)]
pub(crate) fn mistake(cause: &Cause) -> impl Fn(&Primitive, &Ray) -> Option<Answer> + use<> {
    let made = MISTAKES.iter().find(|(known, _)| *known == cause).unwrap().1;
    let wrong = Intersection::RIGHT.with(made);
    move |primitive, ray| wrong.answer(primitive, ray)
}
