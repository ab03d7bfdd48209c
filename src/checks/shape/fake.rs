//! A core that intersects by whatever formula a test gives it.

use super::imitation::{Answer, as_hit};
use crate::checks::testing::info;
use crate::contract::{Core, CoreInfo, Hit, Precision, Primitive, Ray, Result};

pub struct Intersects<F>(pub F);

impl<F: Fn(&Primitive, &Ray) -> Option<Answer> + Send> Core for Intersects<F> {
    fn info(&self) -> CoreInfo {
        info(Precision::Double)
    }

    fn intersect_primitive(
        &mut self,
        primitive: &Primitive,
        rays: &[Ray],
        hits: &mut [Hit],
    ) -> Result<()> {
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = as_hit((self.0)(primitive, ray));
        }
        Ok(())
    }
}
