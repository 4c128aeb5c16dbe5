//! The differentiable cloth as one operation of burn: its forward pass is an equilibrium, its backward pass one sparse
//! solve per item.

use std::sync::{Arc, Mutex};

use burn::backend::autodiff::{
    Autodiff,
    checkpoint::{base::Checkpointer, strategy::CheckpointStrategy},
    grads::Gradients,
    ops::{Backward, Ops, OpsKind},
};
use burn::backend::ops::FloatTensorOps;
use burn::backend::tensor::FloatTensor;
use burn::backend::{Backend, Dispatch, Flex, TensorMetadata, backend_extension};
use burn::tensor::{Tensor, TensorData, read_sync};

use super::springs::CHANNELS;
use super::{ClothError, Scene, Solution};

/// A batch of shapes at rest, on their way through the backends.
type Batch = Arc<Vec<Solution>>;

/// Backends that carry the operation. The shapes are computed before, where errors can be answered; the backend puts them
/// into a tensor that depends on the field.
#[backend_extension(Autodiff, Flex)]
pub trait ClothBackend: Backend {
    /// Positions [batch, particles, 3] in m of `batch`, which was computed from `field` [batch, 4, rows, columns].
    fn shapes_at_rest(field: FloatTensor<Self>, batch: Arc<Vec<Solution>>) -> FloatTensor<Self>;
}

impl ClothBackend for Flex {
    fn shapes_at_rest(field: FloatTensor<Self>, batch: Batch) -> FloatTensor<Self> {
        let particles = field.shape()[2] * field.shape()[3];
        let positions = batch.iter().flat_map(|s| s.positions().as_flattened()).map(|&x| x as f32).collect::<Vec<_>>();
        Flex::float_from_data(TensorData::new(positions, [batch.len(), particles, 3]), &field.device())
    }
}

/// The backward pass.
#[derive(Debug)]
struct ShapesAtRest;

impl<B: Backend> Backward<B, 1> for ShapesAtRest {
    type State = (Batch, [usize; 2]);

    fn backward(self, ops: Ops<Self::State, 1>, grads: &mut Gradients, _: &mut Checkpointer) {
        let [field] = ops.parents;
        let by_position = grads.consume::<B>(&ops.node);
        let Some(field) = field else { return };
        let device = by_position.device();
        let (batch, [rows, columns]) = ops.state;
        let length = CHANNELS * rows * columns;
        // A gradient that cannot be read is answered with NaN, which the training loop looks for: this trait knows no
        // errors, and a panic would say less.
        let lost = || vec![f32::NAN; batch.len() * length];
        let gradient =
            match read_sync(B::float_into_data(by_position)).map(|d| d.convert::<f32>().try_into_vec::<f32>()) {
                Ok(Ok(by_position)) => vjp(&batch, &by_position, length),
                _ => lost(),
            };
        let data = TensorData::new(gradient, [batch.len(), CHANNELS, rows, columns]);
        grads.register::<B>(field.id, B::float_from_data(data, &device));
    }
}

impl<B: ClothBackend, C: CheckpointStrategy> ClothBackend for Autodiff<B, C> {
    fn shapes_at_rest(field: FloatTensor<Self>, batch: Batch) -> FloatTensor<Self> {
        let (field, node) = field.into_parts();
        let sides = [field.shape()[2], field.shape()[3]];
        match ShapesAtRest.prepare::<C>([node]).compute_bound().stateful() {
            OpsKind::Tracked(prepared) => prepared.finish((batch.clone(), sides), B::shapes_at_rest(field, batch)),
            OpsKind::UnTracked(prepared) => prepared.finish(B::shapes_at_rest(field, batch)),
        }
    }
}

/// Shapes at rest [batch, rows * columns, 3] in m of the stiffness fields `field` [batch, 4, rows, columns] in N/m
/// (channels warp, weft, shear, bend; finite, at least 0), one scene each, differentiable with respect to `field`.
///
/// Every field is projected to its scene's budget first. A scene starts in the last shape that settled, and keeps the new
/// one, so repeated calls are cheap. An item that does not settle has the last shape tried and the gradient zero, and its
/// scene has no [`Scene::start`] afterwards. Items run on as many threads as the machine has; the result does not depend
/// on their number.
///
/// Errors: [`ClothError::Shape`] (number of scenes, shape of the field), [`ClothError::Stiffness`]. On an error no scene
/// is changed.
pub fn equilibrium(field: Tensor<4>, scenes: &mut [Scene]) -> Result<Tensor<3>, ClothError> {
    let dims = field.dims();
    for scene in scenes.iter() {
        let expected = vec![scenes.len(), CHANNELS, scene.springs().rows(), scene.springs().columns()];
        if dims[..] != expected[..] {
            return Err(ClothError::Shape { what: "the batch of stiffness fields", expected, found: dims.to_vec() });
        }
    }
    let unreadable = ClothError::Shape { what: "an unreadable tensor", expected: dims.to_vec(), found: Vec::new() };
    let numbers = field.to_data().convert::<f64>().try_into_vec::<f64>().map_err(|_| unreadable)?;
    if scenes.is_empty() {
        let (expected, found) = (vec![1], vec![0]);
        return Err(ClothError::Shape { what: "the list of scenes", expected, found });
    }
    let fields: Vec<&[f64]> = numbers.chunks_exact(numbers.len() / scenes.len()).collect();
    for (item, (scene, field)) in scenes.iter().zip(&fields).enumerate() {
        scene.check_field(field, item)?;
    }
    let solutions = in_parallel(scenes.iter_mut().zip(fields), threads(), |(scene, field)| scene.solve_checked(field));
    Ok(Tensor::from_dispatch(Dispatch::shapes_at_rest(field.into_dispatch(), Arc::new(solutions))))
}

/// Gradients of all items, `length` numbers each.
fn vjp(batch: &[Solution], by_position: &[f32], length: usize) -> Vec<f32> {
    let items = batch.iter().zip(by_position.chunks_exact(by_position.len() / batch.len()));
    let gradient = |(solution, by_position): (&Solution, &[f32])| {
        let rows: Vec<[f64; 3]> = by_position.chunks_exact(3).map(|p| [p[0], p[1], p[2]].map(f64::from)).collect();
        solution.gradient(&rows).unwrap_or_else(|_| vec![f64::NAN; length])
    };
    in_parallel(items, threads(), gradient).concat().into_iter().map(|g| g as f32).collect()
}

/// Threads that the machine offers.
fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Applies `work` to every item on up to `threads` threads; results come in the order of the items.
fn in_parallel<T: Send, R: Send>(
    items: impl ExactSizeIterator<Item = T> + Send,
    threads: usize,
    work: impl Fn(T) -> R + Sync,
) -> Vec<R> {
    let threads = threads.min(items.len()).max(1);
    if threads == 1 {
        return items.map(work).collect();
    }
    let queue = Mutex::new(items.enumerate());
    let next = || queue.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).next();
    let run = || {
        let mut done = Vec::new();
        while let Some((i, item)) = next() {
            done.push((i, work(item)));
        }
        done
    };
    let mut done = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(run)).collect();
        let mut done = run();
        for other in others {
            match other.join() {
                Ok(part) => done.extend(part),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        done
    });
    done.sort_unstable_by_key(|(i, _)| *i);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::{SceneDef, Springs};
    use burn::tensor::Device;

    const SIDE: usize = 6;

    fn scenes() -> Vec<Scene> {
        let springs = Arc::new(Springs::new(SIDE, SIDE, 1.0, 1.0).unwrap());
        let scene = |pins: &[usize], dt_s: f64| {
            Scene::new(&springs, SceneDef { dt_s, ..SceneDef::hung(&springs, pins) }).unwrap()
        };
        vec![scene(&[0, 5], 1.0 / 120.0), scene(&[0, 1, 2, 3, 4, 5], 1e-4), scene(&[0, 5], 1e-4)]
    }

    fn numbers() -> Vec<f32> {
        let n = SIDE * SIDE;
        let value = |j: usize| [900.0, 600.0, 90.0, 30.0][j % (4 * n) / n] * (1.0 + 0.3 * (j as f32 * 1.7).sin());
        (0..12 * n).map(value).collect()
    }

    fn tensor(numbers: Vec<f32>, device: &Device) -> Tensor<4> {
        Tensor::from_data(TensorData::new(numbers, [3, 4, SIDE, SIDE]), device)
    }

    /// The loss of the test: a fixed weight for each number.
    fn weights(device: &Device) -> Tensor<3> {
        let n = 3 * SIDE * SIDE * 3;
        let numbers: Vec<f32> = (0..n).map(|j| (j as f32 * 0.37).cos()).collect();
        Tensor::from_data(TensorData::new(numbers, [3, SIDE * SIDE, 3]), device)
    }

    #[test]
    fn gradient_through_burn_is_that_of_the_solutions() {
        let device = Device::flex().autodiff();
        let field = tensor(numbers(), &device).require_grad();
        let mut through_burn = scenes();
        let shape = equilibrium(field.clone(), &mut through_burn).unwrap();
        assert_eq!(shape.dims(), [3, SIDE * SIDE, 3]);
        let loss = (shape * weights(&device)).sum();
        let gradient = field.grad(&loss.backward()).unwrap();
        assert_eq!(gradient.dims(), [3, 4, SIDE, SIDE]);
        let gradient = gradient.into_data().try_into_vec::<f32>().unwrap();
        let weights = weights(&device).into_data().try_into_vec::<f32>().unwrap();
        let length = 4 * SIDE * SIDE;
        for (item, mut scene) in scenes().into_iter().enumerate() {
            let field: Vec<f64> = numbers()[item * length..][..length].iter().map(|&k| f64::from(k)).collect();
            let solution = scene.solve(&field).unwrap();
            assert_eq!(Some(solution.positions()), through_burn[item].start());
            let by_position: Vec<[f64; 3]> = weights[item * SIDE * SIDE * 3..][..SIDE * SIDE * 3]
                .chunks_exact(3)
                .map(|w| [w[0], w[1], w[2]].map(f64::from))
                .collect();
            let expected = solution.gradient(&by_position).unwrap();
            assert!(expected.iter().any(|g| *g != 0.0));
            for (found, expected) in gradient[item * length..].iter().zip(&expected) {
                assert_eq!(*found, *expected as f32);
            }
        }
    }

    #[test]
    fn descends_through_operations_before_and_after() {
        // Log stiffness in, mean height of the lower edge out: following the gradient lifts the edge as much as it says.
        let device = Device::flex().autodiff();
        let mut scenes = scenes();
        let mut height = |log: Vec<f32>| {
            let log = tensor(log, &device).require_grad();
            let shape = equilibrium(log.clone().exp(), &mut scenes).unwrap();
            let lower = shape.slice([0..3, (SIDE - 1) * SIDE..SIDE * SIDE, 1..2]).mean();
            let gradient = log.grad(&lower.backward()).unwrap();
            (lower.into_scalar::<f32>(), gradient.into_data().try_into_vec::<f32>().unwrap())
        };
        let log: Vec<f32> = numbers().iter().map(|k| k.ln()).collect();
        let (before, gradient) = height(log.clone());
        let norm = gradient.iter().map(|g| g * g).sum::<f32>();
        let rate = 0.05 / gradient.iter().fold(0.0, |m: f32, g| m.max(g.abs()));
        let moved = |sign: f32| log.iter().zip(&gradient).map(|(x, g)| x + sign * rate * g).collect();
        let (above, below) = (height(moved(1.0)).0, height(moved(-1.0)).0);
        let (found, expected) = ((above - below) / 2.0, rate * norm);
        assert!(above > before && before > below);
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    }

    #[test]
    fn answers_bad_input() {
        let device = Device::flex();
        let mut scenes = scenes();
        let short = Tensor::<4>::ones([2, 4, SIDE, SIDE], &device);
        assert!(matches!(equilibrium(short, &mut scenes), Err(ClothError::Shape { .. })));
        let wide = Tensor::<4>::ones([3, 4, SIDE, SIDE + 1], &device);
        assert!(matches!(equilibrium(wide, &mut scenes), Err(ClothError::Shape { .. })));
        let mut bad = numbers();
        bad[(4 + 2) * SIDE * SIDE + 3 * SIDE + 1] = f32::NAN;
        let error = equilibrium(tensor(bad, &device), &mut scenes).unwrap_err();
        assert_eq!(error, ClothError::Stiffness { item: 1, channel: 2, row: 3, column: 1 });
        assert!(scenes.iter().all(|s| s.start().is_none()));
        let one = Tensor::<4>::ones([1, 4, SIDE, SIDE], &device);
        assert!(matches!(equilibrium(one, &mut []), Err(ClothError::Shape { .. })));
    }

    #[test]
    fn an_item_that_does_not_settle_has_no_gradient() {
        let device = Device::flex().autodiff();
        let mut scenes = scenes();
        let mut field = numbers();
        field[4 * SIDE * SIDE..8 * SIDE * SIDE].fill(0.0);
        let field = tensor(field, &device).require_grad();
        let shape = equilibrium(field.clone(), &mut scenes).unwrap();
        let gradient = field.grad(&shape.sum().backward()).unwrap().into_data().try_into_vec::<f32>().unwrap();
        let any = |item: usize| gradient[item * 4 * SIDE * SIDE..][..4 * SIDE * SIDE].iter().any(|g| *g != 0.0);
        assert_eq!([any(0), any(1), any(2)], [true, false, true]);
        assert!(scenes[1].start().is_none() && scenes[2].start().is_some());
    }

    #[test]
    fn the_number_of_threads_does_not_matter() {
        let fields: Vec<Vec<f64>> =
            numbers().chunks_exact(4 * SIDE * SIDE).map(|f| f.iter().map(|&k| f64::from(k)).collect()).collect();
        let run = |threads: usize| -> Vec<Vec<[f64; 3]>> {
            let mut scenes = scenes();
            let work = |(scene, field): (&mut Scene, &Vec<f64>)| scene.solve_checked(field).positions().to_vec();
            in_parallel(scenes.iter_mut().zip(&fields), threads, work)
        };
        let one = run(1);
        assert!(run(2) == one && run(3) == one && run(16) == one);
    }
}
