"""3D Gaussians from arrays: the pictures of files, and what is refused."""
import pickle
import unittest
import warnings

import numpy as np

import halflit

RANDOM = np.random.default_rng(7)
COUNT = 200
POSITIONS = RANDOM.normal(0, 1, (COUNT, 3)).astype(np.float32)
ROTATIONS = RANDOM.normal(0, 1, (COUNT, 4)).astype(np.float32)
LOG_SCALES = RANDOM.uniform(-3, -1, (COUNT, 3)).astype(np.float32)
LOGITS = RANDOM.uniform(-2, 4, COUNT).astype(np.float32)
UPRIGHT = np.diag([1, -1, -1, 1])  # of files of training programs, whose y points down


def gaussians(colors, count=COUNT, **keywords):
    scales, opacities = np.exp(LOG_SCALES.astype(float)), 1 / (1 + np.exp(-LOGITS.astype(float)))
    return halflit.Splats(POSITIONS[:count], ROTATIONS[:count], scales[:count], opacities[:count], colors, **keywords)


def harmonics(degree):
    return np.random.default_rng(degree).uniform(-0.6, 0.6, (COUNT, (degree + 1) ** 2, 3)).astype(np.float32)


def trained(coefficients, size=1.0):
    """The PLY of a training program: w first, and the coefficients after the first channel by channel. size: factor on all lengths."""
    rest = coefficients[:, 1:].transpose(0, 2, 1).reshape(COUNT, -1)
    names = ["x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", *(f"f_rest_{i}" for i in range(rest.shape[1])), "opacity"]
    names += ["scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"]
    columns = [POSITIONS * size, coefficients[:, 0], rest, LOGITS[:, None], LOG_SCALES + np.log(size), ROTATIONS[:, [3, 0, 1, 2]]]
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {COUNT}\n" + "".join(f"property float {name}\n" for name in names)
    return (header + "end_header\n").encode() + np.concatenate(columns, axis=1).astype("<f4").tobytes()


def render(mesh, **keywords):
    scene = halflit.Scene()
    scene.add_mesh(mesh, matrix=UPRIGHT)
    return scene.render((80, 60), **keywords)


class Splats(unittest.TestCase):
    def test_arrays_have_the_picture_of_the_file(self):
        for degree in range(5):
            expected = halflit.render(trained(harmonics(degree)), (80, 60))
            picture = render(gaussians(harmonics(degree)))
            self.assertEqual(picture.pixel_hash, expected.pixel_hash, degree)
            self.assertGreater(len(np.unique(np.asarray(picture).reshape(-1, 4), axis=0)), 500)

    def test_tiny_files_look_as_large_ones(self):
        expected = np.asarray(halflit.render(trained(harmonics(1)), (80, 60))).astype(int)
        scene = halflit.Scene.load(trained(harmonics(1), 2.0**-40))
        self.assertLessEqual(np.abs(scene.render((80, 60)) - expected).max(), 1)
        splats = gaussians(harmonics(1))
        splats.positions, splats.scales = splats.positions * np.float32(2.0**-40), splats.scales * np.float32(2.0**-40)
        scene.set_mesh(0, splats, material=0)
        self.assertLessEqual(np.abs(scene.render((80, 60)) - expected).max(), 1)

    def test_colours(self):
        codes = RANDOM.integers(0, 256, (COUNT, 3)).astype(np.uint8)
        first = render(gaussians(codes)).pixel_hash
        self.assertEqual(render(gaussians(codes / 255)).pixel_hash, first)
        self.assertEqual(render(gaussians((codes[:, None] / 255 - 0.5) / 0.28209479177387814)).pixel_hash, first)
        # One opaque Gaussian in the way of all rays has its own colour, whichever space it is blended in.
        for linear_light in (False, True):
            wall = halflit.Splats(np.zeros((30, 3)), np.zeros((30, 4)), np.full((30, 3), 9), np.ones(30),
                                  np.full((30, 3), (200, 100, 50), np.uint8), linear_light=linear_light)  # fmt: skip
            middle = np.asarray(halflit.render(wall, 32, camera=halflit.Camera.look_at((0, 0, 40), (0, 0, 0)))[16, 16])
            np.testing.assert_allclose(middle, (200, 100, 50, 255), atol=1)

    def test_references_differ(self):
        hashes = {render(gaussians(harmonics(0), reference=name)).pixel_hash for name in ("inria", "inria_aa", "khr", "mip")}
        self.assertEqual(len(hashes), 4)

    def test_wherever_a_mesh_is(self):
        splats = gaussians(harmonics(1))
        expected = halflit.render(splats, 64)
        self.assertEqual([p.pixel_hash for p in halflit.render_meshes([splats, {"vertices": splats}], 64)], [expected.pixel_hash] * 2)
        scene = halflit.Scene()
        mesh = scene.add_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
        scene.set_mesh(mesh, splats)
        self.assertEqual(scene.render(64).pixel_hash, expected.pixel_hash)
        self.assertEqual(pickle.loads(pickle.dumps(scene)).render(64).pixel_hash, expected.pixel_hash)
        with self.assertRaisesRegex(halflit.UsageError, "mesh 0: has Gaussians"):
            scene.set_vertices(mesh, POSITIONS)

    def test_positions_that_are_not_finite_are_left_out(self):
        splats = gaussians(harmonics(0))
        splats.positions = np.concatenate([POSITIONS[:-1], [[np.nan, 0, 0]]])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            picture = render(splats)
        self.assertIn("1 that are not finite", str(caught[0].message))
        self.assertEqual(picture.pixel_hash, render(gaussians(harmonics(0)[:-1], COUNT - 1)).pixel_hash)

    def test_what_is_wrong_is_refused(self):
        good = dict(positions=POSITIONS, rotations=ROTATIONS, scales=np.exp(LOG_SCALES), opacities=np.ones(COUNT), colors=harmonics(0))
        for wrong, words in (
            ({"positions": POSITIONS[:, :2]}, r"positions: expected an array of shape \(n, 3\)"),
            ({"rotations": ROTATIONS[:, :3]}, r"rotations: expected an array of shape \(200, 4\), found \(200, 3\)"),
            ({"scales": LOG_SCALES}, r"scales: row \d+ is .*, expected finite numbers from 0"),
            ({"scales": LOG_SCALES[:5]}, r"scales: expected an array of shape \(200, 3\), found \(5, 3\)"),
            ({"opacities": LOGITS}, r"opacities: row \d+ is .*, expected finite numbers from 0 to 1"),
            ({"opacities": np.ones((COUNT, 1))}, r"opacities: expected an array of shape \(200,\)"),
            ({"rotations": ROTATIONS * np.nan}, "rotations: row 0 is .*, expected finite numbers"),
            ({"colors": harmonics(4)[:, :16][:7]}, r"colors: expected an array of shape \(200, 16, 3\), found \(7, 16, 3\)"),
            ({"colors": harmonics(4)[:, :5]}, "colors: expected an array of shape .* k = 1, 4, 9, 16 or 25"),
            ({"colors": np.full((COUNT, 3), 255)}, "colors: row 0 is .*, expected finite numbers from 0 to 1"),
            ({"reference": "nerf"}, "reference: expected one of inria, inria_aa, khr, mip"),
        ):
            with self.assertRaisesRegex(halflit.UsageError, words):
                halflit.Splats(**{**good, **wrong})
        scene = halflit.Scene()
        with self.assertRaisesRegex(halflit.UsageError, "faces: expected none beside Splats"):
            scene.add_mesh(halflit.Splats(**good), np.zeros((1, 3), int))
        self.assertEqual((scene.counts["meshes"], scene.counts["materials"]), (0, 0))


if __name__ == "__main__":
    unittest.main()
