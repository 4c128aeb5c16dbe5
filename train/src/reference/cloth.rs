//! The cloth in motion: linearly implicit Euler (Baraff, Witkin 1998), as ARCSim steps it.

use super::ReferenceError;
use super::fabrics::Material;
use super::hinge::Hinge;
use super::membrane::Triangle;
use super::sheet::Sheet;
use super::solid::Solid;
use super::vector::{V3, along, cross, dot, length, outer, scale, sub};
use crate::sparse::{Matrix, Pattern, Place};

/// A contact's stiffness over m/dt^2 of its vertex: what was inside is out to a hundredth after a step.
const CONTACT: f64 = 100.0;

/// The longest step that a contact's stiffness goes by, in s.
const LONGEST_S: f64 = 1.0 / 240.0;

/// The longest step of the search for rest, in s: no mass to speak of.
const LARGEST_S: f64 = 100.0;

/// Sliding slower than this is sticking, in m/s.
const STICK_M_S: f64 = 1e-4;

/// What acts on a cloth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Gravity in m/s^2.
    pub gravity_m_s2: V3,
    /// Density of the still air in kg/m^3: each triangle feels density |v_n| v_n per area along its normal.
    pub air_kg_m3: f64,
    /// Drag of the air along the cloth, in kg/(m^2 s): per area and speed. 0 in the scenes; it brings a cloth to rest.
    pub drag_kg_m2_s: f64,
    /// What the cloth lies on.
    pub solid: Option<Solid>,
    /// How far from the solid the cloth is held, in m.
    pub thickness_m: f64,
    /// Coulomb's coefficient between cloth and solid.
    pub friction: f64,
}

impl Default for Surroundings {
    /// Those of ARCSim's scenes, without a solid.
    fn default() -> Surroundings {
        Surroundings {
            gravity_m_s2: [0.0, -9.8, 0.0],
            air_kg_m3: 1.0,
            drag_kg_m2_s: 0.0,
            solid: None,
            thickness_m: 0.0,
            friction: 0.0,
        }
    }
}

/// A continuum cloth.
pub struct Cloth {
    material: Material,
    around: Surroundings,
    /// Positions in m and velocities in m/s.
    x: Vec<V3>,
    v: Vec<V3>,
    mass: Vec<f64>,
    triangles: Vec<Triangle>,
    hinges: Vec<Hinge>,
    /// Forces of the solid on each vertex along its normal in the last step, in N: what friction goes by.
    pressed_n: Vec<f64>,
    pattern: Pattern,
    matrix: Matrix,
    /// Where the blocks lie: of triangles, of hinges, of vertices.
    triangle_places: Vec<[Option<Place>; 6]>,
    hinge_places: Vec<[Option<Place>; 10]>,
    vertex_places: Vec<Option<Place>>,
}

/// A vertex that meets the solid within a step.
struct Contact {
    node: usize,
    normal: V3,
    /// How deep it would go, in m.
    depth_m: f64,
    /// In N/m.
    stiffness: f64,
    /// Velocity before the step in m/s.
    before: V3,
}

impl Cloth {
    /// A cloth at `x` (m, one entry per vertex of the sheet) and at rest, with these vertices pinned. Errors: lengths,
    /// numbers, pins, [`ReferenceError::Factorisation`].
    pub fn new(
        sheet: &Sheet,
        material: Material,
        around: Surroundings,
        x: Vec<V3>,
        pins: &[usize],
    ) -> Result<Cloth, ReferenceError> {
        let n = sheet.uv.len();
        if x.len() != n {
            return Err(ReferenceError::Length { what: "the positions", expected: n, found: x.len() });
        }
        if x.as_flattened().iter().any(|x| !x.is_finite()) {
            return Err(ReferenceError::NotFinite);
        }
        let density = material.density_kg_m2;
        if !(density.is_finite() && density > 0.0) {
            return Err(ReferenceError::OutOfRange { what: "the density in kg/m^2", value: density });
        }
        for (what, value) in [
            ("the density of the air in kg/m^3", around.air_kg_m3),
            ("the drag of the air in kg/(m^2 s)", around.drag_kg_m2_s),
            ("the thickness in m", around.thickness_m),
            ("the friction", around.friction),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(ReferenceError::OutOfRange { what, value });
            }
        }
        let mut pinned = vec![false; n];
        for &p in pins {
            *pinned.get_mut(p).ok_or(ReferenceError::Pins)? = true;
        }
        if pinned.iter().all(|p| *p) {
            return Err(ReferenceError::Pins);
        }
        let mut mass = vec![0.0; n];
        for t in &sheet.triangles {
            for i in t {
                mass[*i] += density * sheet.area_m2(*t) / 3.0;
            }
        }
        let triangles: Vec<Triangle> = sheet.triangles.iter().map(|t| Triangle::new(sheet, *t)).collect();
        let hinges: Vec<Hinge> = sheet.hinges.iter().map(|h| Hinge::new(sheet, *h)).collect();
        let sides = sheet.triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
        let pattern = Pattern::new(&pinned, sides.chain(sheet.hinges.iter().map(|[_, _, l, r]| [*l, *r])))
            .ok_or(ReferenceError::Factorisation)?;
        let triangle_places = triangles.iter().map(|t| places(&pattern, t.nodes)).collect();
        let hinge_places = hinges.iter().map(|h| places(&pattern, h.nodes)).collect();
        let vertex_places = (0..n).map(|i| pattern.place(i, i)).collect();
        let matrix = Matrix::new(&pattern);
        Ok(Cloth {
            material,
            around,
            v: vec![[0.0; 3]; n],
            x,
            mass,
            triangles,
            hinges,
            pressed_n: vec![0.0; n],
            pattern,
            matrix,
            triangle_places,
            hinge_places,
            vertex_places,
        })
    }

    /// Positions in m.
    pub fn positions(&self) -> &[V3] {
        &self.x
    }

    /// Velocities in m/s.
    pub fn velocities(&self) -> &[V3] {
        &self.v
    }

    /// Masses of the vertices in kg.
    pub fn masses_kg(&self) -> &[f64] {
        &self.mass
    }

    /// Moves a vertex, a pinned one too. Panics where there is none.
    pub fn set_position(&mut self, vertex: usize, x: V3) {
        self.x[vertex] = x;
    }

    /// Gives a vertex a velocity. Panics where there is none.
    pub fn set_velocity(&mut self, vertex: usize, v: V3) {
        self.v[vertex] = v;
    }

    /// Root mean square speed in m/s.
    pub fn rms_speed_m_s(&self) -> f64 {
        (self.v.iter().map(|v| dot(*v, *v)).sum::<f64>() / self.v.len() as f64).sqrt()
    }

    /// Elastic energy in J: exact for a material whose stiffness does not change.
    pub fn energy_j(&self) -> f64 {
        let stretched = self.triangles.iter().map(|t| t.energy(&t.at(&self.x, &self.material.membrane)));
        let folded = self.hinges.iter().filter_map(|h| Some(h.energy(&h.at(&self.x, &self.material.bending)?)));
        stretched.sum::<f64>() + folded.sum::<f64>()
    }

    /// Elastic forces on all vertices in N.
    pub fn elastic_forces_n(&self) -> Vec<V3> {
        let mut forces = vec![[0.0; 3]; self.x.len()];
        for t in &self.triangles {
            let now = t.at(&self.x, &self.material.membrane);
            for (i, f) in t.nodes.iter().zip(t.forces(&now)) {
                forces[*i] = along(forces[*i], 1.0, f);
            }
        }
        for h in &self.hinges {
            if let Some(now) = h.at(&self.x, &self.material.bending) {
                for (i, f) in h.nodes.iter().zip(h.forces(&now)) {
                    forces[*i] = along(forces[*i], 1.0, f);
                }
            }
        }
        forces
    }

    /// One step of `dt_s`: solves (M - dt^2 J) dv = dt (f + dt J v) for the change of the velocities, then moves with the
    /// new ones. J is the positive semidefinite part of the forces' derivative at fixed stiffness. Errors:
    /// [`ReferenceError::OutOfRange`] for the step, [`ReferenceError::Factorisation`], [`ReferenceError::NotFinite`].
    pub fn step(&mut self, dt_s: f64) -> Result<(), ReferenceError> {
        if !(dt_s.is_finite() && dt_s > 0.0) {
            return Err(ReferenceError::OutOfRange { what: "the step in s", value: dt_s });
        }
        self.advance(dt_s, true)
    }

    /// Goes to rest from where it is: Newton steps with a mass that fades while they go well, cut short where the forces
    /// turn against them (for a table whose stiffness changes there is no energy to go by). Ends where no free vertex feels
    /// more than `tolerance` of the mean weight of a vertex, and says in how many steps. The solid holds, friction is not
    /// at work. Errors: as of [`Cloth::step`], [`ReferenceError::NotAtRest`] after `most` steps.
    pub fn settle(&mut self, tolerance: f64, most: usize) -> Result<usize, ReferenceError> {
        let weight = length(self.around.gravity_m_s2) * self.mass.iter().sum::<f64>() / self.mass.len() as f64;
        let mut dt = LONGEST_S;
        for step in 0..most {
            self.v.fill([0.0; 3]);
            let residual = self.residual_n();
            if residual <= tolerance * weight {
                return Ok(step);
            }
            let before = self.x.clone();
            let forces = self.forces_at_rest();
            self.advance(dt, false)?;
            let way: Vec<V3> = self.x.iter().zip(&before).map(|(a, b)| sub(*a, *b)).collect();
            let work = |forces: &[V3]| forces.iter().zip(&way).map(|(f, d)| dot(*f, *d)).sum::<f64>();
            let least = -0.5 * work(&forces).abs();
            let mut share = 1.0;
            while work(&self.forces_at_rest()) < least && share > 1e-3 {
                share *= 0.5;
                for ((x, b), d) in self.x.iter_mut().zip(&before).zip(&way) {
                    *x = along(*b, share, *d);
                }
            }
            dt = if share == 1.0 { (2.0 * dt).min(LARGEST_S) } else { (0.5 * dt).max(0.25 * LONGEST_S) };
        }
        self.v.fill([0.0; 3]);
        Err(ReferenceError::NotAtRest { residual_n: self.residual_n() })
    }

    /// What moves a cloth that has no velocity: elastic forces, weight, the solid.
    fn forces_at_rest(&self) -> Vec<V3> {
        let mut forces = self.elastic_forces_n();
        for (i, f) in forces.iter_mut().enumerate() {
            *f = along(*f, self.mass[i], self.around.gravity_m_s2);
            if let Some(solid) = self.around.solid {
                let (distance, normal) = solid.distance(self.x[i]);
                let stiffness = CONTACT * self.mass[i] / LONGEST_S.powi(2);
                *f = along(*f, stiffness * (self.around.thickness_m - distance).max(0.0), normal);
            }
        }
        forces
    }

    /// The largest force on a free vertex in N: elastic, weight, and the solid's as a spring.
    pub fn residual_n(&self) -> f64 {
        let forces = self.forces_at_rest();
        self.pattern.free().iter().map(|&i| length(forces[i])).fold(0.0, f64::max)
    }

    fn advance(&mut self, dt: f64, in_motion: bool) -> Result<(), ReferenceError> {
        let (right, contacts) = match self.assemble(dt, in_motion, in_motion) {
            (right, contacts) if self.matrix.factorise(&self.pattern) => (right, contacts),
            // the whole derivative is the better one near rest, where it is positive definite
            _ if !in_motion => {
                let retry = self.assemble(dt, in_motion, true);
                if !self.matrix.factorise(&self.pattern) {
                    return Err(ReferenceError::Factorisation);
                }
                retry
            }
            _ => return Err(ReferenceError::Factorisation),
        };
        let mut change: Vec<f64> = self.pattern.free().iter().flat_map(|i| right[*i].map(|f| dt * f)).collect();
        self.matrix.solve(&self.pattern, &mut change);
        for (&i, dv) in self.pattern.free().iter().zip(change.as_chunks::<3>().0) {
            self.v[i] = along(self.v[i], 1.0, *dv);
            self.x[i] = along(self.x[i], dt, self.v[i]);
            if !self.x[i].iter().all(|x| x.is_finite()) {
                return Err(ReferenceError::NotFinite);
            }
        }
        // how hard the solid pressed: what the step left of the depth
        self.pressed_n.fill(0.0);
        for c in contacts {
            let left = c.depth_m - dt * dot(sub(self.v[c.node], c.before), c.normal);
            self.pressed_n[c.node] = c.stiffness * left.max(0.0);
        }
        Ok(())
    }

    /// The matrix and the forces of a step, which it returns with the contacts.
    fn assemble(&mut self, dt: f64, in_motion: bool, convex: bool) -> (Vec<V3>, Vec<Contact>) {
        let mut right = self.outer_forces(in_motion);
        self.matrix.clear();
        // dt (f + dt J v) is dt times the force in the direction of where the vertices go, to first order
        for (t, at) in self.triangles.iter().zip(&self.triangle_places) {
            let now = t.at(&self.x, &self.material.membrane);
            for (i, f) in t.nodes.iter().zip(t.forces(&now)) {
                right[*i] = along(right[*i], 1.0, f);
            }
            let nodes = t.nodes;
            t.hessian(&now, convex, |i, j, block| {
                let rank = i * 3 + j - i * (i + 1) / 2;
                couple(&mut self.matrix, &mut right, &self.v, at[rank], [nodes[i], nodes[j]], block, dt);
            });
        }
        for (h, at) in self.hinges.iter().zip(&self.hinge_places) {
            let Some(now) = h.at(&self.x, &self.material.bending) else { continue };
            for (i, f) in h.nodes.iter().zip(h.forces(&now)) {
                right[*i] = along(right[*i], 1.0, f);
            }
            let nodes = h.nodes;
            h.hessian(&now, |i, j, block| {
                let rank = i * 4 + j - i * (i + 1) / 2;
                couple(&mut self.matrix, &mut right, &self.v, at[rank], [nodes[i], nodes[j]], block, dt);
            });
        }
        let contacts = self.contacts(dt, &mut right, in_motion);
        for (i, m) in self.mass.iter().enumerate() {
            if let Some(place) = self.vertex_places[i] {
                self.matrix.add(place, &[[*m, 0.0, 0.0], [0.0, *m, 0.0], [0.0, 0.0, *m]]);
            }
        }
        (right, contacts)
    }

    /// Weight and, in motion, the air.
    fn outer_forces(&self, in_motion: bool) -> Vec<V3> {
        let Surroundings { gravity_m_s2, air_kg_m3, drag_kg_m2_s, .. } = self.around;
        let mut forces: Vec<V3> = self.mass.iter().map(|m| scale(*m, gravity_m_s2)).collect();
        if !in_motion || (air_kg_m3 == 0.0 && drag_kg_m2_s == 0.0) {
            return forces;
        }
        for t in &self.triangles {
            let [a, b, c] = t.nodes.map(|i| self.x[i]);
            let normal = cross(sub(b, a), sub(c, a));
            let twice = length(normal);
            if twice == 0.0 {
                continue;
            }
            let normal = scale(1.0 / twice, normal);
            let speed = scale(-1.0 / 3.0, t.nodes.iter().fold([0.0; 3], |sum, i| along(sum, 1.0, self.v[*i])));
            let across = dot(speed, normal);
            let push = scale(air_kg_m3 * across.abs() * across, normal);
            let push = along(push, drag_kg_m2_s, along(speed, -across, normal));
            for i in t.nodes {
                forces[i] = along(forces[i], t.area_m2 / 3.0, push);
            }
        }
        forces
    }

    /// Adds the solid's forces where the vertices would be after `dt`, and their friction.
    fn contacts(&mut self, dt: f64, right: &mut [V3], in_motion: bool) -> Vec<Contact> {
        let Some(solid) = self.around.solid else { return vec![] };
        let mut all = Vec::new();
        for node in 0..self.x.len() {
            let Some(place) = self.vertex_places[node] else { continue };
            let (distance, normal) = solid.distance(along(self.x[node], dt, self.v[node]));
            let depth_m = self.around.thickness_m - distance;
            // who was pressed stays in touch until it would pull: a slide over a curve must not lose the ground
            if depth_m <= 0.0 && self.pressed_n[node] == 0.0 {
                continue;
            }
            let stiffness = CONTACT * self.mass[node] / dt.min(LONGEST_S).powi(2);
            right[node] = along(right[node], stiffness * depth_m, normal);
            self.matrix.add(place, &outer(dt * dt * stiffness, normal, normal));
            let before = self.v[node];
            if in_motion {
                // Coulomb's force over the speed acts as a damping, so that a step cannot turn the sliding round
                let sliding = along(before, -dot(before, normal), normal);
                let damping = self.around.friction * self.pressed_n[node] / length(sliding).max(STICK_M_S);
                right[node] = along(right[node], -damping, sliding);
                let n = normal;
                let block = std::array::from_fn(|r| {
                    std::array::from_fn(|c| dt * damping * (f64::from(u8::from(r == c)) - n[r] * n[c]))
                });
                self.matrix.add(place, &block);
            }
            all.push(Contact { node, normal, depth_m, stiffness, before });
        }
        all
    }
}

/// Where the blocks of an element lie, for i <= j.
fn places<const N: usize, const PAIRS: usize>(pattern: &Pattern, nodes: [usize; N]) -> [Option<Place>; PAIRS] {
    let mut all = (0..N).flat_map(|i| (i..N).map(move |j| (i, j)));
    std::array::from_fn(|_| all.next().and_then(|(i, j)| pattern.place(nodes[i], nodes[j])))
}

/// Adds a block of the forces' derivative (with the sign of an energy's) to the matrix, and what it does to the forces
/// while the vertices go on for `dt`.
fn couple(
    matrix: &mut Matrix,
    right: &mut [V3],
    v: &[V3],
    place: Option<Place>,
    [i, j]: [usize; 2],
    block: [V3; 3],
    dt: f64,
) {
    if let Some(place) = place {
        matrix.add(place, &block.map(|row| scale(dt * dt, row)));
    }
    for r in 0..3 {
        right[i][r] -= dt * dot(block[r], v[j]);
    }
    if i != j {
        for (r, row) in block.iter().enumerate() {
            right[j] = along(right[j], -dt * v[i][r], *row);
        }
    }
}
