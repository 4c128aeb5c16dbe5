//! Colliders against closed forms: rest, sliding, dragging, no way through; ids, refusals, rollback, the same bits.

mod common;

use common::contact::{UP, at, turned, with};
use common::{Random, bare, bits, cloth, positions, snapshot, squares, steps, velocities};
use taut::Vector3;
use taut::{Cloth, ClothDef, ColliderDef, ColliderId, Error, Families, Features, MAX_COLLIDERS, Pose, Shape};

const G: f64 = 9.81;

/// 60 x 16, gravity along -y, no damping, no speed limit: loose particles are blocks that slide or fly.
fn free() -> ClothDef {
    ClothDef {
        damping_per_s: 0.0,
        speed_limit: 0.0,
        budget: taut::Budget::Certified,
        features: Features::COLLIDERS,
        ..ClothDef::default()
    }
}

/// Particles without springs between them.
fn loose(rows: u32, columns: u32, def: &ClothDef) -> Cloth<'static> {
    let mut c = cloth(&squares(rows, columns, 0.05, Families::ALL), def);
    c.set_stiffness_uniform([0.0; 4]).unwrap();
    c
}

/// A cloth that falls on a floor lies exactly a thickness above it, at rest.
#[test]
fn a_cloth_lies_a_thickness_above_a_plane() {
    let def = ClothDef { damping_per_s: 1.0, v_axis: [0.0, 0.0, 1.0], ..free() };
    for stiffness in [0.0, 300.0] {
        let mut c = cloth(&squares(9, 20, 0.05, Families::ALL), &def);
        c.set_stiffness_uniform([stiffness, stiffness, 0.3 * stiffness, 0.0]).unwrap();
        c.add_collider(&with(UP, at(5.0, -0.3, 2.0), 0.5, 0.0125)).unwrap();
        for _ in 0..120 {
            steps(&mut c, 1);
            assert!(positions(&c).iter().all(|p| p.y >= -0.2875 - 1e-6));
        }
        for (p, v) in positions(&c).iter().zip(velocities(&c)) {
            assert!((p.y + 0.2875).abs() < 1e-6, "{p}");
            assert!(v.norm() < 1e-6, "{v}");
        }
    }
}

/// A block on a slope: acceleration g (sin a - mu cos a) from rest, or none where mu > tan a. Symplectic Euler from rest
/// goes a dt^2 n (n + 1) / 2.
#[test]
fn a_block_slides_as_coulomb_says() {
    let (frames, dt) = (30, f64::from(free().dt_s()));
    let n = f64::from(frames as u32 * 16);
    for degrees in [5.0f64, 20.0, 35.0, 60.0] {
        for mu in [0.0, 0.1, 0.5, 1.0] {
            let angle = degrees.to_radians();
            let mut c = loose(3, 4, &free());
            // downhill is +x
            let normal = [angle.sin() as f32, angle.cos() as f32, 0.0];
            c.add_collider(&with(Shape::Plane { normal }, at(0.0, 0.0, 0.0), mu as f32, 0.01)).unwrap();
            let up = Vector3::new(angle.sin(), angle.cos(), 0.0);
            let along = Vector3::new(angle.cos(), -angle.sin(), 0.0);
            let start = |i: usize| along * (0.05 * i as f64 - 0.3) + up * 0.01 + Vector3::new(0.0, 0.0, 0.1);
            for i in 0..12 {
                c.set_position(i, start(i).cast()).unwrap();
            }
            steps(&mut c, frames);
            let a = (G * (angle.sin() - mu * angle.cos())).max(0.0);
            let expected = a * dt * dt * n * (n + 1.0) / 2.0;
            for (i, (p, v)) in positions(&c).iter().zip(velocities(&c)).enumerate() {
                let moved = p.cast::<f64>() - start(i);
                // f32 positions of about 1 m, 480 times rounded
                let tolerance = 1e-5 + 1e-4 * expected;
                assert!((moved.dot(&along) - expected).abs() < tolerance, "{degrees} {mu}: {moved} {expected}");
                assert!(moved.dot(&up).abs() < 2e-6, "{degrees} {mu}: {moved}");
                assert!((v.cast::<f64>().dot(&along) - a * dt * n).abs() < 1e-3 * (1.0 + a), "{degrees} {mu}: {v}");
            }
        }
    }
}

/// What falls on a floor stops: the normal velocity is taken whole, the tangential one by mu times that.
#[test]
fn an_impact_is_inelastic_and_takes_mu_times_its_impulse() {
    let def = ClothDef { gravity_m_s2: [0.0; 3], ..free() };
    for (mu, expected) in [(0.0, 3.0), (0.25, 2.0), (0.75, 0.0), (5.0, 0.0)] {
        let mut c = loose(2, 2, &def);
        c.add_collider(&with(UP, at(0.0, 0.0, 0.0), mu, 0.0)).unwrap();
        for i in 0..4 {
            c.set_position(i, Vector3::new(0.0, 0.02, 0.1 * i as f32)).unwrap();
            c.set_velocity(i, Vector3::new(0.0, -4.0, 3.0)).unwrap();
        }
        steps(&mut c, 1);
        for v in velocities(&c) {
            assert!(v.x.abs() < 1e-6 && v.y.abs() < 1e-6 && (v.z - expected).abs() < 1e-5, "{mu}: {v}");
        }
    }
}

/// A belt that runs at 1 m/s: what lies on it is dragged at mu g until it has the speed of the belt.
#[test]
fn a_belt_drags_to_its_speed() {
    let mu = 0.2;
    let mut c = loose(2, 3, &ClothDef { v_axis: [0.0, 0.0, 1.0], ..free() });
    let belt = c.add_collider(&with(UP, at(0.0, -0.01, 0.0), mu, 0.01)).unwrap();
    for frame in 1..=60 {
        let t = f64::from(frame) / 60.0;
        c.move_collider(belt, &at(t, -0.01, 0.0)).unwrap();
        steps(&mut c, 1);
        let expected = (f64::from(mu) * G * t).min(1.0);
        for v in velocities(&c) {
            let off = Vector3::new(f64::from(v.x) - expected, v.y.into(), v.z.into());
            assert!(off.norm() < 2e-3, "{t} s: {v} instead of {expected}");
        }
    }
    // a belt that is not moved again stands still, and what lies on it stops
    steps(&mut c, 60);
    assert!(velocities(&c).iter().all(|v| v.norm() < 1e-5));
    assert!((c.collider(belt).unwrap().pose.position_m.x - 1.0).abs() < 1e-6);
}

/// A turning table: while w^2 r < mu g a particle goes round with it.
#[test]
fn a_turning_table_carries_what_lies_on_it() {
    let w = std::f64::consts::TAU * 0.5;
    let mut c = loose(2, 2, &free());
    let shape = Shape::Box { half_m: [0.5, 0.1, 0.5] };
    let table = c.add_collider(&with(shape, at(0.0, -0.1, 0.0), 1.0, 0.0)).unwrap();
    let start = [0.05f32, 0.1, 0.15, 0.2];
    for (i, r) in start.into_iter().enumerate() {
        c.set_position(i, Vector3::new(r, 0.0, 0.0)).unwrap();
        c.set_velocity(i, Vector3::new(0.0, 0.0, -(w as f32) * r)).unwrap();
    }
    for frame in 1..=120 {
        let angle = w * f64::from(frame) / 60.0;
        c.move_collider(table, &turned(Vector3::new(0.0, -0.1, 0.0), [0.0, 1.0, 0.0], angle)).unwrap();
        steps(&mut c, 1);
        for (i, r) in start.into_iter().enumerate() {
            let (p, v) = (c.position(i).unwrap(), c.velocity(i).unwrap());
            let (s, k) = angle.sin_cos();
            let there = Vector3::new(k, 0.0, -s) * f64::from(r);
            // friction acts at the end of each substep, so a circle of n places a turn slips outward a little
            assert!((p.cast::<f64>() - there).norm() < 0.02 * f64::from(r) * angle, "{r} {angle}: {p}");
            let speed = v.cast::<f64>().norm();
            assert!((speed / (w * f64::from(r)) - 1.0).abs() < 0.05, "{r} {angle}: {speed}");
        }
    }
}

/// A cloth that falls over a ball is never inside it.
#[test]
fn a_cloth_drapes_over_a_sphere() {
    let def =
        ClothDef { features: Features::COLLIDERS, v_axis: [0.0, 0.0, 1.0], damping_per_s: 4.0, ..ClothDef::default() };
    let mut c = cloth(&squares(25, 25, 0.025, Families::ALL), &def);
    c.set_stiffness_uniform([800.0, 800.0, 200.0, 10.0]).unwrap();
    let centre = Vector3::new(0.3f64, -0.2, 0.3);
    c.add_collider(&with(Shape::Sphere { radius_m: 0.12 }, Pose::at(centre), 0.4, 0.005)).unwrap();
    let mut deepest = f64::INFINITY;
    for _ in 0..240 {
        steps(&mut c, 1);
        for p in positions(&c) {
            deepest = deepest.min((p.cast::<f64>() - centre).norm() - 0.125);
        }
    }
    assert!(deepest > -1e-5, "{deepest}");
    // the middle lies on top, the corners hang
    let top = c.position(12 * 25 + 12).unwrap().cast::<f64>() - centre;
    assert!((top.y - 0.125).abs() < 1e-4 && top.norm() < 0.1251, "{top}");
    assert!(c.position(0).unwrap().y < -0.3);
    let on = positions(&c).iter().filter(|p| (p.cast::<f64>() - centre).norm() < 0.1251).count();
    assert!(on > 20, "{on} particles lie on it");
    assert!(c.kinetic_energy_j() < 1e-5);
}

/// One frame of four substeps moves a collider as four frames of one substep with a quarter of the way each. Numbers are
/// multiples of a power of two, so that both are exact; frames without motion of their own compare the middles.
#[test]
fn colliders_are_interpolated_over_the_substeps() {
    let mut pair = [(60.0, 4), (240.0, 1)].map(|(rate_hz, substeps)| {
        let def = ClothDef { rate_hz, substeps, features: Features::COLLIDERS, ..ClothDef::default() };
        let mut c = cloth(&squares(9, 9, 0.125, Families::ALL), &def);
        c.set_stiffness_uniform([200.0, 100.0, 30.0, 2.0]).unwrap();
        c.pin(0).unwrap();
        c.pin(8).unwrap();
        let ball = with(Shape::Sphere { radius_m: 0.25 }, at(0.5, -0.5, -0.5), 0.5, 0.0625);
        let id = c.add_collider(&ball).unwrap();
        (c, id)
    });
    let mut z = -0.5;
    for frame in 0..20 {
        let way = if frame % 5 == 4 { -0.0625 } else { 0.0625 };
        let [(coarse, id), (fine, other)] = &mut pair;
        coarse.move_collider(*id, &at(0.5, -0.5, z + way)).unwrap();
        steps(coarse, 1);
        for quarter in 1..=4 {
            fine.move_collider(*other, &at(0.5, -0.5, z + way * f64::from(quarter) / 4.0)).unwrap();
            steps(fine, 1);
        }
        z += way;
        assert_eq!(bits(coarse), bits(fine), "frame {frame}");
    }
    let furthest = positions(&pair[0].0).iter().fold(0.0f32, |a, p| a.max(p.z));
    assert!(furthest > 0.2, "the ball did push: {furthest}");
}

/// The least distance of a way to the middle of a ball.
fn nearest(from: Vector3<f64>, to: Vector3<f64>) -> f64 {
    let way = to - from;
    let t = if way.norm_squared() > 0.0 { (-from.dot(&way) / way.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
    (from + way * t).norm()
}

/// A ball of 5 cm at 20 m/s, 2 cm a substep: no particle's way, seen from the ball, enters it; however thin the skin, and
/// whether the ball, the particles or both move.
#[test]
fn no_particle_passes_through_a_fast_ball() {
    for (ball, particle) in [(20.0, 0.0), (0.0, -20.0), (10.0, -10.0), (100.0, -100.0)] {
        for thickness in [0.0, 0.005] {
            // a frame is a substep, so that every way is seen
            let def = ClothDef { rate_hz: 960.0, substeps: 1, gravity_m_s2: [0.0; 3], ..free() };
            let mut c = cloth(&squares(16, 16, 0.01, Families::ALL), &def);
            c.set_stiffness_uniform([0.0; 4]).unwrap();
            let mut random = Random::new(3);
            for i in 0..256 {
                let p = Vector3::new(0.01 * (i % 16) as f32, -0.01 * (i / 16) as f32, 0.0);
                c.set_position(i, p + random.vector(0.002)).unwrap();
                c.set_velocity(i, Vector3::new(0.0, 0.0, particle)).unwrap();
            }
            let centre = |t: f64| Vector3::new(0.075, -0.075, -0.2 + ball * t);
            let shape = Shape::Sphere { radius_m: 0.05 };
            let id = c.add_collider(&with(shape, Pose::at(centre(0.0)), 0.3, thickness)).unwrap();
            let size = f64::from(0.05 + thickness);
            let (mut least, mut pushed) = (f64::INFINITY, 0);
            for frame in 0..40 {
                let (t0, t1) = (f64::from(frame) / 960.0, f64::from(frame + 1) / 960.0);
                let before = positions(&c);
                c.move_collider(id, &Pose::at(centre(t1))).unwrap();
                let straight = velocities(&c);
                steps(&mut c, 1);
                for (i, (p, q)) in before.iter().zip(positions(&c)).enumerate() {
                    least = least.min(nearest(p.cast() - centre(t0), q.cast() - centre(t1)));
                    pushed += usize::from(c.velocity(i).unwrap() != straight[i]);
                }
            }
            assert!(least > size - 1e-5, "{ball} {particle} {thickness}: {least}");
            assert!(pushed > 60, "{pushed}");
        }
    }
}

/// A ball of 5 cm and a skin of 1 cm against a hanging cloth with cells of 3 cm. At 5 m/s and 60 x 16, and at 20 m/s and
/// 60 x 64, the cloth is carried along. At 20 m/s and 60 x 16 it cannot follow (its waves are slower than the ball) and
/// opens, but no particle is ever inside or passes through.
#[test]
fn a_fast_ball_meets_a_hanging_cloth() {
    for (speed, rate_hz, carried) in [(5.0, 960.0f32, true), (20.0, 3840.0, true), (20.0, 960.0, false)] {
        let def = ClothDef { features: Features::COLLIDERS, rate_hz, substeps: 1, ..ClothDef::default() };
        let n = 32;
        let mut c = cloth(&common::grid(32, 32, 1.0, 1.0, Families::ALL), &def);
        c.set_stiffness_uniform([5000.0, 5000.0, 1500.0, 50.0]).unwrap();
        for p in 0..n {
            c.pin(p).unwrap();
        }
        let (radius, skin) = (0.05, 0.01);
        let centre = |t: f64| Vector3::new(0.503, -0.507, -0.2 + speed * t);
        let ball = with(Shape::Sphere { radius_m: radius }, Pose::at(centre(0.0)), 0.3, skin);
        let id = c.add_collider(&ball).unwrap();
        let frames = (0.45 / speed * f64::from(rate_hz)) as u32;
        let mut least = f64::INFINITY;
        let mut before = positions(&c);
        for frame in 0..frames {
            let [t0, t1] = [frame, frame + 1].map(|f| f64::from(f) / f64::from(rate_hz));
            c.move_collider(id, &Pose::at(centre(t1))).unwrap();
            steps(&mut c, 1);
            let now = positions(&c);
            for (p, q) in before.iter().zip(&now) {
                least = least.min(nearest(p.cast() - centre(t0), q.cast() - centre(t1)));
            }
            before = now;
        }
        let size = f64::from(radius + skin);
        assert!(least > size - 1e-5, "{speed} {rate_hz}: {}", least - size);
        let end = centre(f64::from(frames) / f64::from(rate_hz));
        let seen: Vec<_> = before.iter().map(|p| p.cast::<f64>() - end).collect();
        let ahead = seen.iter().filter(|d| d.z > 0.0 && d.xy().norm() < size).count();
        let mut cut = 0;
        for i in 0..n * n {
            let pairs = [(i % n + 1 < n, i + 1), (i + n < n * n, i + n)];
            cut += pairs.iter().filter(|(is, j)| *is && nearest(seen[i], seen[*j]) < 0.9 * f64::from(radius)).count();
        }
        println!("{speed} m/s at {rate_hz} Hz: {ahead} particles ahead, {cut} springs through the ball");
        if carried {
            assert!(ahead >= 4 && cut == 0, "{speed} {rate_hz}: {ahead} {cut}");
        }
    }
}

/// Plates of 2 mm and a half space, at 20 and 100 m/s, straight and at a slant: what was in front stays in front.
#[test]
fn no_particle_passes_through_a_thin_plate() {
    let plate = Shape::Box { half_m: [0.5, 0.001, 0.5] };
    let rod = Shape::Capsule { ends_m: [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]], radii_m: [0.5, 0.4] };
    for shape in [plate, UP, rod] {
        for speed in [20.0, 100.0] {
            for thickness in [0.0, 0.003] {
                for slant in [0.0f64, 0.5] {
                    for moving in [false, true] {
                        let def = ClothDef { gravity_m_s2: [0.0; 3], ..free() };
                        let mut c = loose(6, 6, &def);
                        let normal = Vector3::new(-slant.sin(), slant.cos(), 0.0);
                        let along = Vector3::new(slant.cos(), slant.sin(), 0.0);
                        let base = if shape == rod { normal * -0.5 } else { Vector3::zeros() };
                        let pose = |t: f64| turned(base + normal * (speed * t), [0.0, 0.0, 1.0], slant);
                        let id = c.add_collider(&with(shape, pose(0.0), 0.2, thickness)).unwrap();
                        let mut random = Random::new(9);
                        for i in 0..36 {
                            let side = Vector3::new(0.0, 0.0, f64::from(random.within(-0.1, 0.1)));
                            let p = normal * f64::from(random.within(0.05, 0.5))
                                + along * f64::from(random.within(-0.1, 0.1))
                                + side;
                            c.set_position(i, p.cast()).unwrap();
                            let v = if moving { Vector3::zeros() } else { normal * -speed };
                            c.set_velocity(i, v.cast()).unwrap();
                        }
                        let mut touched = 0;
                        for frame in 1..=3 {
                            let t = f64::from(frame) / 60.0;
                            if moving {
                                c.move_collider(id, &pose(t)).unwrap();
                            }
                            steps(&mut c, 1);
                            let now = c.collider(id).unwrap().pose.position_m;
                            touched = 0;
                            for p in positions(&c) {
                                // at least the skin above the middle plane of the plate; the rod is in the way of all
                                let height = (p.cast::<f64>() - now).dot(&normal);
                                let least = if shape == rod { 0.0 } else { f64::from(thickness) - 1e-5 };
                                assert!(height > least, "{shape:?} {speed} {thickness} {slant} {moving}: {height}");
                                touched += usize::from(height < 0.6);
                            }
                        }
                        assert!(speed < 50.0 || touched > 10, "{shape:?} {speed} {slant} {moving}: {touched}");
                    }
                }
            }
        }
    }
}

/// Two planes that meet: nothing is inside either, though each pushes into the other.
#[test]
fn nothing_is_inside_where_colliders_meet() {
    for degrees in [60.0f64, 90.0, 120.0] {
        let half = degrees.to_radians() / 2.0;
        let normals = [1.0, -1.0].map(|side| [(side * half.cos()) as f32, half.sin() as f32, 0.0]);
        let mut c = loose(4, 10, &free());
        for normal in normals {
            c.add_collider(&with(Shape::Plane { normal }, at(0.2, -0.5, 0.0), 0.0, 0.01)).unwrap();
        }
        let mut deepest = 0.0f32;
        for _ in 0..60 {
            steps(&mut c, 1);
            for p in positions(&c) {
                for n in normals {
                    let d = (p - Vector3::new(0.2, -0.5, 0.0)).dot(&Vector3::from(n)) - 0.01;
                    deepest = deepest.min(d);
                }
            }
        }
        println!("{degrees} degrees: {deepest} m");
        // an acute wedge is left with what four rounds of cos^2(a) leave
        assert!(deepest > if degrees < 90.0 { -1e-3 } else { -1e-5 }, "{degrees}: {deepest}");
    }
}

/// Particles that are inside from the start come out without being thrown: the collider moves each by 1/16 of a cell in a
/// substep at most, and gives it no velocity.
#[test]
fn what_is_inside_at_the_start_comes_out_gently() {
    let def = ClothDef { gravity_m_s2: [0.0; 3], rate_hz: 960.0, substeps: 1, ..free() };
    let mut c = cloth(&squares(9, 9, 0.02, Families::ALL), &def);
    let centre = Vector3::new(0.08f32, -0.08, 0.003);
    let ball = with(Shape::Sphere { radius_m: 0.05 }, Pose::at(centre.cast()), 0.3, 0.005);
    let inside = |p: &&Vector3<f32>| (*p - centre).norm() < 0.055 - 2e-5;
    for stiffness in [0.0, 200.0] {
        c.reset();
        c.set_stiffness_uniform([stiffness, stiffness, 0.3 * stiffness, 0.0]).unwrap();
        c.add_collider(&ball).unwrap();
        let mut before = positions(&c);
        assert!(before.iter().filter(inside).count() > 15);
        let (mut fastest, mut last) = (0.0f32, 0);
        for substep in 0..240 {
            steps(&mut c, 1);
            let (now, speeds) = (positions(&c), velocities(&c));
            for ((p, q), v) in before.iter().zip(&now).zip(&speeds) {
                let own = v.norm() / 960.0;
                assert!((p - q).norm() < 0.02 / 16.0 + own + 1e-6 || stiffness > 0.0, "{p} {q}");
            }
            fastest = speeds.iter().fold(fastest, |a, v| a.max(v.norm()));
            before = now;
            if before.iter().filter(inside).count() > 0 {
                last = substep;
            }
        }
        println!("stiffness {stiffness}: the last one came out in substep {last}, the fastest had {fastest} m/s");
        if stiffness == 0.0 {
            // 5.5 cm are 44 sixteenths of a cell
            assert!(fastest == 0.0 && (30..44).contains(&last), "{fastest} {last}");
        } else {
            assert!(last < 44, "{last}");
        }
    }
    // a jump of the collider into the cloth is treated alike
    let mut c = loose(2, 2, &def);
    let id = c.add_collider(&with(UP, at(0.0, -9.0, 0.0), 0.3, 0.0)).unwrap();
    c.set_collider_pose(id, &at(0.0, 0.1, 0.0)).unwrap();
    steps(&mut c, 1);
    let y = c.position(0).unwrap().y;
    assert!((y - 0.003125).abs() < 1e-6, "1/16 of the cell of 5 cm: {y}");
    assert_eq!(c.velocity(0).unwrap(), Vector3::zeros());
    steps(&mut c, 60);
    assert!(positions(&c).iter().all(|p| (p.y - 0.1).abs() < 1e-6));
}

/// A pin goes where it is told, through a collider too; and a collider far away changes no bit.
#[test]
fn pins_and_far_colliders_are_as_without() {
    let run = |collider: Option<(Shape, Pose)>| {
        let def = ClothDef { features: Features::COLLIDERS, ..ClothDef::default() };
        let mut c = cloth(&squares(12, 17, 0.05, Families::ALL), &def);
        c.set_stiffness_uniform([300.0, 300.0, 90.0, 6.0]).unwrap();
        if let Some((shape, pose)) = collider {
            c.add_collider(&ColliderDef::new(shape, pose)).unwrap();
        }
        for p in [0, 16] {
            c.pin(p).unwrap();
        }
        for frame in 0..40 {
            c.move_pin(0, Vector3::new(0.0, 0.0, 0.01 * f64::from(frame))).unwrap();
            steps(&mut c, 1);
        }
        (bits(&c), c.position(0).unwrap(), c.position(16).unwrap())
    };
    let alone = run(None);
    let ball = Shape::Sphere { radius_m: 0.3 };
    for (shape, pose) in [
        (ball, at(0.0, 2.0, 0.0)),
        (UP, at(0.0, -3.0, 0.0)),
        (Shape::Box { half_m: [0.1, 1.0, 0.1] }, at(3.0, 0.0, 0.0)),
        (Shape::Capsule { ends_m: [[0.0; 3], [9.0, 0.0, 0.0]], radii_m: [0.1; 2] }, at(0.0, 0.0, -2.0)),
    ] {
        assert!(run(Some((shape, pose))) == alone, "{shape:?}");
    }
    let near = run(Some((ball, at(0.8, 0.0, 0.1))));
    assert!(near.0 != alone.0);
    assert_eq!((near.1, near.2), (alone.1, alone.2), "pinned within the ball");
}

#[test]
fn ids_are_values_that_do_not_come_back() {
    let mut c = loose(2, 2, &free());
    let def = ColliderDef::new(Shape::Sphere { radius_m: 0.1 }, at(9.0, 0.0, 0.0));
    assert_eq!(c.remove_collider(ColliderId(0)), Err(Error::NoSuchCollider));
    let mut seen = std::collections::HashSet::new();
    let mut live: Vec<ColliderId> = (0..MAX_COLLIDERS).map(|_| c.add_collider(&def).unwrap()).collect();
    assert_eq!(c.add_collider(&def), Err(Error::TooManyColliders));
    assert_eq!(c.collider_count(), MAX_COLLIDERS);
    seen.extend(live.iter().copied());
    let mut random = Random::new(1);
    for _ in 0..500 {
        let gone = live.swap_remove(random.below(live.len()));
        c.remove_collider(gone).unwrap();
        for answer in [c.remove_collider(gone), c.move_collider(gone, &def.pose), c.set_collider_pose(gone, &def.pose)]
        {
            assert_eq!(answer, Err(Error::NoSuchCollider));
        }
        let id = c.add_collider(&def).unwrap();
        assert!(id.0 != 0 && seen.insert(id), "{id:?} was given before");
        assert_eq!(c.collider(gone), Err(Error::NoSuchCollider));
        live.push(id);
    }
    for id in &live {
        assert_eq!(c.collider(*id), Ok(def));
    }
    // a state that is gone back to gives the ids again that it gave
    let saved = snapshot(&mut c);
    c.remove_collider(live[3]).unwrap();
    let next = c.add_collider(&def).unwrap();
    c.restore(&saved).unwrap();
    assert_eq!(c.collider(next), Err(Error::NoSuchCollider));
    c.remove_collider(live[3]).unwrap();
    assert_eq!(c.add_collider(&def), Ok(next));
    c.reset();
    assert_eq!(c.collider_count(), 0);
    assert_eq!(c.collider(live[0]), Err(Error::NoSuchCollider));
}

#[test]
fn bad_colliders_are_refused_and_change_nothing() {
    let mut c = loose(2, 2, &free());
    let good = ColliderDef::new(Shape::Sphere { radius_m: 0.1 }, at(9.0, 0.0, 0.0));
    let id = c.add_collider(&good).unwrap();
    let hash = c.state_hash();
    let mut refused = |def: ColliderDef, error: Error| assert_eq!(c.add_collider(&def), Err(error), "{def:?}");
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        refused(ColliderDef { friction: x, ..good }, Error::NotFinite);
        refused(ColliderDef { thickness_m: x, ..good }, Error::NotFinite);
        refused(ColliderDef { shape: Shape::Sphere { radius_m: x }, ..good }, Error::NotFinite);
        refused(ColliderDef { pose: at(0.0, f64::from(x), 0.0), ..good }, Error::NotFinite);
        let rotation = [0.0, x, 0.0, 1.0];
        refused(ColliderDef { pose: Pose { rotation, ..good.pose }, ..good }, Error::NotFinite);
    }
    refused(ColliderDef { shape: Shape::Sphere { radius_m: 0.0 }, ..good }, Error::OutOfRange);
    refused(ColliderDef { shape: Shape::Box { half_m: [0.1, 0.0, 0.1] }, ..good }, Error::OutOfRange);
    refused(ColliderDef { friction: -0.1, ..good }, Error::Negative);
    refused(ColliderDef { thickness_m: -0.1, ..good }, Error::Negative);
    refused(ColliderDef { friction: 101.0, ..good }, Error::OutOfRange);
    refused(ColliderDef { thickness_m: 1001.0, ..good }, Error::OutOfRange);
    refused(ColliderDef { pose: at(0.0, 1.1e6, 0.0), ..good }, Error::OutOfRange);
    refused(ColliderDef { pose: Pose { rotation: [0.0; 4], ..good.pose }, ..good }, Error::OutOfRange);
    for pose in [at(f64::NAN, 0.0, 0.0), Pose { rotation: [f32::NAN; 4], ..good.pose }] {
        assert_eq!(c.move_collider(id, &pose), Err(Error::NotFinite));
        assert_eq!(c.set_collider_pose(id, &pose), Err(Error::NotFinite));
    }
    assert_eq!(c.move_collider(id, &at(0.0, -2e6, 0.0)), Err(Error::OutOfRange));
    assert_eq!(c.state_hash(), hash);
    let mut without = loose(2, 2, &bare());
    assert_eq!(without.add_collider(&good), Err(Error::FeatureOff));
    assert_eq!(without.move_collider(id, &good.pose), Err(Error::NoSuchCollider));
    assert_eq!(without.collider_count(), 0);
}
