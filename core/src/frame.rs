//! The moving frame: a cloth that follows a character.
//!
//! The state lives in local coordinates: the world less the frame's position, with the axes of the world. A new frame moves
//! the cloth rigidly by the share 1 - inertia of the frame's own motion (the turn about the frame's position first, then
//! the shift), which costs no strain and gives no velocity; only the rest of the motion is felt, through pins and
//! colliders. So inertia 0 is a cloth that does not notice that its character runs, and 1 one that physics alone moves.

use crate::layout::read;
use crate::pins::Pin;
use crate::{Cloth, ClothDef, Error, Pose, Vector3};

/// Longest way of a frame in one call, in m along an axis.
const REACH_M: f64 = 1e6;

/// The frame as it is kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    pub position: [f64; 3],
    /// x, y, z, w of length 1.
    pub rotation: [f64; 4],
}

impl Frame {
    /// That of the definition.
    pub fn new(def: &ClothDef) -> Frame {
        Frame { position: def.origin_m, rotation: [0.0, 0.0, 0.0, 1.0] }
    }

    fn of(pose: &Pose) -> Result<Frame, Error> {
        let [x, y, z, w] = pose.rotation.map(f64::from);
        let length = libm::sqrt(x * x + y * y + z * z + w * w);
        if !length.is_finite() {
            return Err(Error::NotFinite);
        }
        if !(1e-3..=1e3).contains(&length) {
            return Err(Error::OutOfRange);
        }
        Frame { position: pose.position_m.into(), rotation: [x, y, z, w].map(|q| q / length) }.checked()
    }

    /// Checks a frame that may be anything. Errors: [`Error::NotFinite`], [`Error::OutOfRange`].
    pub fn checked(self) -> Result<Frame, Error> {
        if !self.numbers().iter().all(|x| x.is_finite()) {
            return Err(Error::NotFinite);
        }
        let [x, y, z, w] = self.rotation;
        if self.position.iter().any(|x| x.abs() > 1e12) || (x * x + y * y + z * z + w * w - 1.0).abs() > 1e-9 {
            return Err(Error::OutOfRange);
        }
        Ok(self)
    }

    pub fn numbers(&self) -> [f64; 7] {
        let ([a, b, c], [x, y, z, w]) = (self.position, self.rotation);
        [a, b, c, x, y, z, w]
    }

    pub fn from_numbers([a, b, c, x, y, z, w]: [f64; 7]) -> Frame {
        Frame { position: [a, b, c], rotation: [x, y, z, w] }
    }
}

/// What a new frame does to local coordinates.
pub(crate) struct Motion {
    /// Rows of the turn that is carried along; none where nothing turns, so that the bits stay.
    turn: Option<[[f64; 3]; 3]>,
    /// The same as a quaternion x, y, z, w; 0, 0, 0, 1 where nothing turns.
    quaternion: [f64; 4],
    /// The part of the way that is not carried along.
    felt: [f64; 3],
    /// The whole way.
    way: [f64; 3],
}

impl Motion {
    /// From one frame to another; `linear` and `angular` are the shares (0 to 1) that are felt.
    fn new(from: &Frame, to: &Frame, linear: f64, angular: f64) -> Motion {
        let way = [0, 1, 2].map(|a| to.position[a] - from.position[a]);
        let quaternion = turn(from.rotation, to.rotation, 1.0 - angular);
        Motion {
            turn: quaternion.map(matrix),
            quaternion: quaternion.unwrap_or([0.0, 0.0, 0.0, 1.0]),
            felt: way.map(|d| linear * d),
            way,
        }
    }

    /// A direction or a velocity that is carried along.
    pub fn carry_vector(&self, v: [f32; 3]) -> [f32; 3] {
        let Some(rows) = self.turn else {
            return v;
        };
        let [x, y, z] = v.map(f64::from);
        rows.map(|[a, b, c]| (a * x + b * y + c * z) as f32)
    }

    /// A place that is carried along: a particle, or where a pin, collider or target was.
    pub fn carry(&self, p: [f32; 3]) -> [f32; 3] {
        less(self.carry_vector(p), self.felt)
    }

    /// The rotation of a collider that is carried along.
    pub fn carry_rotation(&self, q: [f32; 4]) -> [f32; 4] {
        if self.turn.is_none() {
            return q;
        }
        let [ax, ay, az, aw] = self.quaternion;
        let [bx, by, bz, bw] = q.map(f64::from);
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ]
        .map(|x| x as f32)
    }

    /// A place that stays where it is in the world: where a pin, collider or target goes to.
    pub fn keep(&self, p: [f32; 3]) -> [f32; 3] {
        less(p, self.way)
    }
}

fn less(p: [f32; 3], d: [f64; 3]) -> [f32; 3] {
    [0, 1, 2].map(|a| (f64::from(p[a]) - d[a]) as f32)
}

/// The rotation that takes `from` to `to` the shorter way, of which only a share is turned; none where nothing turns.
fn turn(from: [f64; 4], to: [f64; 4], share: f64) -> Option<[f64; 4]> {
    let [ax, ay, az, aw] = to;
    // from, backwards
    let [bx, by, bz, bw] = [-from[0], -from[1], -from[2], from[3]];
    let [x, y, z, w] = [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ];
    let sine = libm::sqrt(x * x + y * y + z * z);
    // a product of equal rotations is off by rounding, and must not turn anything
    if from == to || sine < 1e-15 || share == 0.0 {
        return None;
    }
    let sign = if w < 0.0 { -1.0 } else { 1.0 };
    let half = share * libm::atan2(sine, sign * w);
    let (s, w) = (libm::sin(half) * sign / sine, libm::cos(half));
    Some([x * s, y * s, z * s, w])
}

/// The rows of the matrix of a rotation.
fn matrix([x, y, z, w]: [f64; 4]) -> [[f64; 3]; 3] {
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

impl Cloth<'_> {
    /// The frame is at a new place, at the end of the next step. Pins and colliders still go where they were told to be in the
    /// world, so it does not matter whether they are moved before or after this call.
    ///
    /// `linear_inertia` and `angular_inertia`, 0 to 1, are the shares of the frame's shift and turn that the cloth feels;
    /// with the rest of them it is carried along, its velocities turned with it. A pin that is not moved stays where it is
    /// in the world. Turning rounds the positions to f32; a shift alone with inertia 0 leaves particles bit-identical.
    ///
    /// Errors: [`Error::NotFinite`], [`Error::OutOfRange`] (a share, the length of the quaternion, or a way of more than 1e6
    /// m along an axis: that is a teleport).
    pub fn set_frame(&mut self, frame: &Pose, linear_inertia: f32, angular_inertia: f32) -> Result<(), Error> {
        let to = Frame::of(frame)?;
        let shares = [linear_inertia, angular_inertia];
        if shares.iter().any(|s| s.is_nan()) {
            return Err(Error::NotFinite);
        }
        let motion = Motion::new(&self.frame, &to, linear_inertia.into(), angular_inertia.into());
        if shares.iter().any(|s| !(0.0..=1.0).contains(s)) || motion.way.iter().any(|d| d.abs() > REACH_M) {
            return Err(Error::OutOfRange);
        }
        if to != self.frame {
            self.move_local(&motion, true);
            self.frame = to;
            self.wake();
        }
        Ok(())
    }

    /// The cloth is elsewhere, with its pins, colliders and targets and their ways of the next step: it does not notice.
    /// A change of place leaves the local state bit-identical; a turn rounds positions and velocities to f32.
    ///
    /// Errors: [`Error::NotFinite`], [`Error::OutOfRange`].
    pub fn teleport(&mut self, frame: &Pose) -> Result<(), Error> {
        let to = Frame::of(frame)?;
        let motion = Motion { felt: [0.0; 3], way: [0.0; 3], ..Motion::new(&self.frame, &to, 0.0, 0.0) };
        if motion.turn.is_some() {
            self.move_local(&motion, false);
            self.wake();
        }
        self.frame = to;
        Ok(())
    }

    /// Moves the origin of the local frame, and the cloth with all that is attached to it: for engines that shift their
    /// world. The local state is bit-identical, and so is the hash.
    ///
    /// Errors: [`Error::NotFinite`], [`Error::OutOfRange`] (above 1e12 m).
    pub fn set_origin(&mut self, origin_m: Vector3<f64>) -> Result<(), Error> {
        self.frame = Frame { position: origin_m.into(), ..self.frame }.checked()?;
        Ok(())
    }

    /// Where the frame is.
    pub fn frame(&self) -> Pose {
        Pose { position_m: self.frame.position.into(), rotation: self.frame.rotation.map(|q| q as f32) }
    }

    /// Carries all that is local along. The targets of pins stay in the world, or are carried too.
    fn move_local(&mut self, motion: &Motion, in_world: bool) {
        let l = self.layout;
        for row in 0..l.rows {
            for column in 0..l.columns {
                let at = l.at(row, column);
                let p = motion.carry(self.local(at));
                self.set_position_at(at, p);
                if motion.turn.is_some() {
                    let v = [&*self.v.x, &*self.v.y, &*self.v.z].map(|v| read(v, at));
                    self.set_velocity_at(at, motion.carry_vector(v));
                }
            }
        }
        for i in 0..self.pins.count {
            let Pin { particle, from, to } = self.pins.get(i);
            let to = if in_world { motion.keep(to) } else { motion.carry(to) };
            self.pins.set(i, Pin { particle, from: motion.carry(from), to });
        }
        // the step before was in another frame
        self.implicit.reset();
        self.carry_colliders(motion, in_world);
        self.carry_targets(motion, in_world);
    }
}
