"""Checks a generator file with onnx.checker and compares onnxruntime with answers of other runtimes.

    onnx_parity.py MODEL SAMPLE...

SAMPLE is a JSON file, or a folder of them (*.json), with the keys tokens, weights, noise, pin_distance (the inputs of
the file) and field, fabric (what another runtime answered), flat or nested, for one batch. Exit code 0 when the file
is valid and every answer agrees to --tolerance, 1 otherwise.
"""

import argparse
import json
import pathlib
import sys

import numpy
import onnx
import onnxruntime

INPUTS = {
    "tokens": (numpy.int64, (-1, 16)),
    "weights": (numpy.float32, (-1, 16)),
    "noise": (numpy.float32, (-1, 128)),
    "pin_distance": (numpy.float32, (-1, 1, 32, 32)),
}
OUTPUTS = {"field": (-1, 4, 32, 32), "fabric": (-1, 5)}


def sample_files(paths):
    """The files named, and the *.json of the folders named."""
    for path in map(pathlib.Path, paths):
        yield from sorted(path.glob("*.json")) if path.is_dir() else [path]


def check(model_path):
    """Validates the file (full check: types and shapes inferred) and its declared inputs and outputs."""
    model = onnx.load(str(model_path))
    onnx.checker.check_model(model, full_check=True)
    inputs = [i.name for i in model.graph.input]
    outputs = [o.name for o in model.graph.output]
    if inputs != list(INPUTS) or outputs != list(OUTPUTS):
        raise ValueError(f"inputs {inputs}, outputs {outputs}")
    opset = {o.domain: o.version for o in model.opset_import}
    operators = sorted({n.op_type for n in model.graph.node})
    print(f"{model_path}: valid, ir {model.ir_version}, opset {opset}, operators {' '.join(operators)}")


def compare(session, path):
    """The largest difference of each output between onnxruntime and the sample."""
    sample = json.loads(path.read_text())
    feed = {name: numpy.array(sample[name], kind).reshape(shape) for name, (kind, shape) in INPUTS.items()}
    answers = session.run(list(OUTPUTS), feed)
    worst = {}
    for (name, shape), answer in zip(OUTPUTS.items(), answers):
        other = numpy.array(sample[name], numpy.float32).reshape(shape)
        if other.shape != answer.shape:
            raise ValueError(f"{path}: {name} has shape {other.shape}, onnxruntime gives {answer.shape}")
        # NaN anywhere makes this NaN, which is no agreement.
        worst[name] = float(numpy.max(numpy.abs(other - answer)))
    return worst


def main():
    """Runs both checks and prints one line each."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model", type=pathlib.Path)
    parser.add_argument("samples", nargs="+")
    parser.add_argument("--tolerance", type=float, default=1e-5)
    arguments = parser.parse_args()
    check(arguments.model)
    session = onnxruntime.InferenceSession(str(arguments.model), providers=["CPUExecutionProvider"])
    files = list(sample_files(arguments.samples))
    if not files:
        raise ValueError(f"no samples in {arguments.samples}")
    agree = True
    for path in files:
        worst = compare(session, path)
        good = all(w <= arguments.tolerance for w in worst.values())
        agree &= good
        print(f"{path}: {'agrees' if good else 'DIFFERS'}, largest differences {worst}")
    return 0 if agree else 1


if __name__ == "__main__":
    sys.exit(main())
