//! Colliders: their list, ids and poses. What they do to the particles is in `contact`.

use crate::cloth::REACH_M;
use crate::frame::Motion;
use crate::layout::{Layout, read, take, write};
use crate::math::{round16, sqrt};
use crate::shapes::{SHAPE_NUMBERS, Shape};
use crate::{Cloth, Error, Pose, Vector3};

/// Most colliders of a cloth.
pub const MAX_COLLIDERS: usize = 32;

/// f32 numbers of a collider.
pub(crate) const COLLIDER_NUMBERS: usize = 32;

/// Where the numbers of a collider lie: kind (0 = none), generation, friction, thickness, shape, pose at the start of the
/// frame, pose at its end.
const KIND: usize = 0;
const GENERATION: usize = 1;
const FRICTION: usize = 2;
const THICKNESS: usize = 3;
const SHAPE: usize = 4;
const FROM: usize = SHAPE + SHAPE_NUMBERS;
const TO: usize = FROM + POSE_NUMBERS;
/// Position and rotation.
const POSE_NUMBERS: usize = 7;
const _: () = assert!(TO + POSE_NUMBERS <= COLLIDER_NUMBERS);

/// Generations of a place in the list: whole numbers that f32 holds exactly. A place that has had them all is not used again.
const GENERATIONS: f32 = 16_777_215.0;

/// A collider, by value. 0 is none. The id of a removed collider is not given again within a run; like everything else
/// it is part of the state, so a frame that is stepped again after [`Cloth::restore`] or [`Cloth::reset`] gives the same
/// ids again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct ColliderId(pub u32);

/// What a collider is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColliderDef {
    /// The shape, in the collider's own frame.
    pub shape: Shape,
    /// Where it is.
    pub pose: Pose,
    /// Coefficient of Coulomb friction, 0 to 100.
    pub friction: f32,
    /// Distance from the shape that the particles keep, in m, 0 to 1e3.
    pub thickness_m: f32,
}

impl ColliderDef {
    /// A collider with friction 0.3 and a thickness of 5 mm.
    pub fn new(shape: Shape, pose: Pose) -> ColliderDef {
        ColliderDef { shape, pose, friction: 0.3, thickness_m: 0.005 }
    }

    /// Errors: [`Error::NotFinite`], [`Error::Negative`], [`Error::OutOfRange`]. The pose is checked where it becomes local.
    fn check(&self) -> Result<(), Error> {
        self.shape.check()?;
        if !self.friction.is_finite() || !self.thickness_m.is_finite() {
            return Err(Error::NotFinite);
        }
        if self.friction < 0.0 || self.thickness_m < 0.0 {
            return Err(Error::Negative);
        }
        if self.friction > 100.0 || self.thickness_m > 1e3 {
            return Err(Error::OutOfRange);
        }
        Ok(())
    }
}

/// A pose in the local frame: position in m, rotation of length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LocalPose {
    pub position: Vector3<f32>,
    pub rotation: [f32; 4],
}

/// A collider as it is stored.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Collider {
    pub shape: Shape,
    pub friction: f32,
    pub thickness: f32,
    pub from: LocalPose,
    pub to: LocalPose,
}

/// The colliders of a cloth. All their numbers are state.
pub(crate) struct Colliders<'a> {
    pub numbers: &'a mut [f32],
}

impl<'a> Colliders<'a> {
    /// f32 numbers that they need.
    pub fn numbers(l: &Layout) -> usize {
        round16(COLLIDER_NUMBERS * l.max_colliders)
    }

    pub fn new(l: &Layout, block: &mut &'a mut [f32]) -> Result<Self, Error> {
        Ok(Colliders { numbers: take(block, Self::numbers(l))? })
    }

    /// The collider at a place of the list.
    pub fn get(&self, place: usize) -> Option<Collider> {
        collider_at(self.numbers, place)
    }

    /// The place of a collider. Error: [`Error::NoSuchCollider`].
    fn find(&self, id: ColliderId) -> Result<usize, Error> {
        let place = id.0 as usize % MAX_COLLIDERS;
        let number = |i: usize| read(self.numbers, place * COLLIDER_NUMBERS + i);
        if number(KIND) == 0.0 || number(GENERATION) as u32 != id.0 / MAX_COLLIDERS as u32 {
            return Err(Error::NoSuchCollider);
        }
        Ok(place)
    }

    fn put(&mut self, place: usize, from: usize, values: &[f32]) {
        for (i, v) in values.iter().enumerate() {
            write(self.numbers, place * COLLIDER_NUMBERS + from + i, *v);
        }
    }

    fn put_pose(&mut self, place: usize, from: usize, pose: &LocalPose) {
        let (p, [x, y, z, w]) = (pose.position, pose.rotation);
        self.put(place, from, &[p.x, p.y, p.z, x, y, z, w]);
    }
}

fn decode(number: impl Fn(usize) -> f32) -> Option<Collider> {
    let pose = |at: usize| LocalPose {
        position: Vector3::new(number(at), number(at + 1), number(at + 2)),
        rotation: [number(at + 3), number(at + 4), number(at + 5), number(at + 6)],
    };
    let mut shape = [0.0; SHAPE_NUMBERS];
    for (i, s) in shape.iter_mut().enumerate() {
        *s = number(SHAPE + i);
    }
    Some(Collider {
        shape: Shape::decode(number(KIND), shape)?,
        friction: number(FRICTION),
        thickness: number(THICKNESS),
        from: pose(FROM),
        to: pose(TO),
    })
}

/// The collider at a place of a list.
pub(crate) fn collider_at(numbers: &[f32], place: usize) -> Option<Collider> {
    let number = |i| read(numbers, place * COLLIDER_NUMBERS + i);
    // most places are empty, and this is asked in every substep
    if number(KIND) == 0.0 { None } else { decode(number) }
}

/// Whether the numbers of a snapshot from `first` on are colliders that could have been added.
/// Errors: those of [`Cloth::add_collider`].
pub(crate) fn check_stored(number: &impl Fn(usize) -> f32, first: usize) -> Result<(), Error> {
    for place in 0..MAX_COLLIDERS {
        let number = |i: usize| number(first + place * COLLIDER_NUMBERS + i);
        let generation = number(GENERATION);
        if !(0.0..=GENERATIONS).contains(&generation) || generation != libm::floorf(generation) {
            return Err(Error::OutOfRange);
        }
        if number(KIND) == 0.0 {
            continue;
        }
        let c = decode(number).ok_or(Error::OutOfRange)?;
        for pose in [c.from, c.to] {
            let reach = pose.position.iter().all(|x| x.abs() <= REACH_M as f32);
            if !reach || !(0.999..=1.001).contains(&norm(pose.rotation)) {
                return Err(Error::OutOfRange);
            }
        }
        let pose = Pose::at(Vector3::zeros());
        ColliderDef { shape: c.shape, pose, friction: c.friction, thickness_m: c.thickness }.check()?;
    }
    Ok(())
}

impl Cloth<'_> {
    /// Adds a collider. Particles that are inside are moved out over the nearest surface, by at most 1/16 of the
    /// smallest rest length in each substep.
    ///
    /// Errors: [`Error::FeatureOff`] without [`crate::Features::COLLIDERS`], [`Error::NotFinite`], [`Error::Negative`],
    /// [`Error::OutOfRange`] (also a size of 0, and a pose more than 1e6 m from the cloth's origin),
    /// [`Error::TooManyColliders`].
    pub fn add_collider(&mut self, def: &ColliderDef) -> Result<ColliderId, Error> {
        if self.layout.max_colliders == 0 {
            return Err(Error::FeatureOff);
        }
        def.check()?;
        let pose = self.local_pose(&def.pose)?;
        let generation = |place: usize| read(self.colliders.numbers, place * COLLIDER_NUMBERS + GENERATION);
        let free = |place: &usize| self.colliders.get(*place).is_none() && generation(*place) < GENERATIONS;
        let place = (0..self.layout.max_colliders).find(free).ok_or(Error::TooManyColliders)?;
        let generation = generation(place) + 1.0;
        let (kind, shape) = def.shape.encode();
        self.colliders.put(place, KIND, &[kind, generation, def.friction, def.thickness_m]);
        self.colliders.put(place, SHAPE, &shape);
        self.colliders.put_pose(place, FROM, &pose);
        self.colliders.put_pose(place, TO, &pose);
        self.wake();
        Ok(ColliderId(generation as u32 * MAX_COLLIDERS as u32 + place as u32))
    }

    /// Moves a collider: at the end of the next frame it is at `pose`, and on the way there its position is interpolated
    /// linearly and its rotation along the shorter arc (normalised linear interpolation). Its surface drags the cloth with
    /// it. Without a new call it then stays.
    ///
    /// Errors: [`Error::NoSuchCollider`], [`Error::NotFinite`], [`Error::OutOfRange`] (more than 1e6 m from the cloth's
    /// origin; a rotation of length 0).
    pub fn move_collider(&mut self, id: ColliderId, pose: &Pose) -> Result<(), Error> {
        let place = self.colliders.find(id)?;
        let pose = self.local_pose(pose)?;
        if self.colliders.get(place).is_some_and(|c| c.to != pose) {
            self.wake();
        }
        self.colliders.put_pose(place, TO, &pose);
        Ok(())
    }

    /// Puts a collider somewhere at once, with no way and no velocity between: what is inside then is treated as in
    /// [`Cloth::add_collider`].
    ///
    /// Errors: those of [`Cloth::move_collider`].
    pub fn set_collider_pose(&mut self, id: ColliderId, pose: &Pose) -> Result<(), Error> {
        let place = self.colliders.find(id)?;
        let pose = self.local_pose(pose)?;
        self.colliders.put_pose(place, FROM, &pose);
        self.colliders.put_pose(place, TO, &pose);
        self.wake();
        Ok(())
    }

    /// Removes a collider; its id is answered with an error from now on.
    ///
    /// Error: [`Error::NoSuchCollider`].
    pub fn remove_collider(&mut self, id: ColliderId) -> Result<(), Error> {
        let place = self.colliders.find(id)?;
        let generation = (id.0 / MAX_COLLIDERS as u32) as f32;
        // everything but the generation, so that the state does not remember what is gone
        self.colliders.put(place, 0, &[0.0; COLLIDER_NUMBERS]);
        self.colliders.put(place, GENERATION, &[generation]);
        self.wake();
        Ok(())
    }

    /// Carries the colliders along with the frame: where they were; where they go stays in the world, or is carried too.
    pub(crate) fn carry_colliders(&mut self, motion: &Motion, in_world: bool) {
        for place in 0..self.layout.max_colliders {
            let Some(c) = self.colliders.get(place) else {
                continue;
            };
            let carried = |p: &LocalPose| LocalPose {
                position: motion.carry(p.position.into()).into(),
                rotation: motion.carry_rotation(p.rotation),
            };
            let to = if in_world {
                LocalPose { position: motion.keep(c.to.position.into()).into(), ..c.to }
            } else {
                carried(&c.to)
            };
            self.colliders.put_pose(place, FROM, &carried(&c.from));
            self.colliders.put_pose(place, TO, &to);
        }
    }

    /// A collider as it is now, before the next frame.
    ///
    /// Error: [`Error::NoSuchCollider`].
    pub fn collider(&self, id: ColliderId) -> Result<ColliderDef, Error> {
        let place = self.colliders.find(id)?;
        let c = self.colliders.get(place).ok_or(Error::NoSuchCollider)?;
        let position_m = c.from.position.cast::<f64>() + Vector3::from(self.frame.position);
        let pose = Pose { position_m, rotation: c.from.rotation };
        Ok(ColliderDef { shape: c.shape, pose, friction: c.friction, thickness_m: c.thickness })
    }

    /// Number of colliders.
    pub fn collider_count(&self) -> usize {
        (0..self.layout.max_colliders).filter(|place| self.colliders.get(*place).is_some()).count()
    }

    fn local_pose(&self, pose: &Pose) -> Result<LocalPose, Error> {
        if !pose.rotation.iter().all(|x| x.is_finite()) {
            return Err(Error::NotFinite);
        }
        let long = norm(pose.rotation);
        if !(1e-3..=1e3).contains(&long) {
            return Err(Error::OutOfRange);
        }
        Ok(LocalPose {
            position: self.to_local(pose.position_m)?.into(),
            // one that has length 1 already stays as it is to the bit: so it may be read and set again
            rotation: if (long - 1.0).abs() <= 2e-7 { pose.rotation } else { pose.rotation.map(|x| x / long) },
        })
    }

    /// The next frame starts where this one ended; after a frame that was taken back (`finite` false), where it began.
    pub(crate) fn finish_colliders(&mut self, finite: bool) {
        for place in 0..self.layout.max_colliders {
            if let Some(c) = self.colliders.get(place) {
                if finite {
                    self.colliders.put_pose(place, FROM, &c.to);
                } else {
                    self.colliders.put_pose(place, TO, &c.from);
                }
            }
        }
    }
}

/// Length of a quaternion.
pub(crate) fn norm(q: [f32; 4]) -> f32 {
    let [x, y, z, w] = q;
    sqrt(x * x + y * y + z * z + w * w)
}
