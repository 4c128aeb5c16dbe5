//! The network sees the pins in training as the runtime shows them.

use taut_lab::scene::Scene;
use taut_train::gan::pin_map;
use taut_train::nets::GRID;

#[test]
fn training_and_runtime_have_one_map_of_the_pins() {
    let mut sets: Vec<Vec<usize>> = Scene::ALL.iter().map(|scene| scene.pins(GRID, GRID)).collect();
    sets.push(Vec::new());
    sets.push(vec![0, 400, 401, GRID * GRID - 1]);
    for pins in sets {
        let places: Vec<(usize, usize)> = pins.iter().map(|p| (p / GRID, p % GRID)).collect();
        let runtime = taut_onnx::pin_distance(GRID, &places, [GRID, GRID], [1.0, 1.0]).expect("good pins");
        let training = pin_map(&pins);
        assert_eq!(training.len(), runtime.len());
        for (i, (a, b)) in training.iter().zip(&runtime).enumerate() {
            assert!((a - b).abs() < 1e-6, "pins {pins:?}, place {i}: {a} against {b}");
        }
    }
}
