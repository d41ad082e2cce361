"""An image of the program, made by umoci and run by bubblewrap."""
import glob
import json
import os
import tempfile
import unittest

from common import PACKAGING, PROGRAM, ROOT, main, need, output, run


def static_program():
    """The program without shared libraries, if it is newer than that of the build; else the latter, whose libraries the image gets."""
    found = glob.glob(os.path.join(ROOT, "build", "portable", "*", "build", "bin", "halflit"))
    newer = [path for path in found if os.path.getmtime(path) >= os.path.getmtime(PROGRAM)]
    return next((path for path in newer if run(path, "--version").returncode == 0), PROGRAM)


class Image(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        need("umoci", "bwrap", "bash")
        if run("bwrap", "--unshare-all", "--ro-bind", "/", "/", "true").returncode:
            raise unittest.SkipTest("bubblewrap cannot make namespaces here")
        cls.temporary = tempfile.TemporaryDirectory()
        cls.layout = os.path.join(cls.temporary.name, "oci")
        output(os.path.join(PACKAGING, "image", "oci.sh"), static_program(), cls.layout, "test")
        cls.bundle = os.path.join(cls.temporary.name, "bundle")
        output("umoci", "unpack", "--rootless", "--image", f"{cls.layout}:test", cls.bundle)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def in_image(self, *arguments):
        """Runs the image's entry point as its configuration says, with its files alone and without a network."""
        with open(os.path.join(self.bundle, "config.json"), encoding="utf-8") as file:
            process = json.load(file)["process"]
        user = process["user"]
        return run("bwrap", "--unshare-all", "--clearenv", "--bind", os.path.join(self.bundle, "rootfs"), "/", "--proc", "/proc", "--dev",
                   "/dev", "--uid", str(user["uid"]), "--gid", str(user["gid"]), "--chdir", process["cwd"], *process["args"], *arguments)

    def test_it_passes_its_own_test(self):
        done = self.in_image("--self-test")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_it_draws_into_its_folder(self):
        done = self.in_image("sphere:500", "a.png", "--size", "32x32")
        self.assertEqual(done.returncode, 0, done.stderr)
        expected = os.path.join(self.temporary.name, "expected.png")
        output(PROGRAM, "sphere:500", expected, "--size", "32x32")
        with open(os.path.join(self.bundle, "rootfs", "work", "a.png"), "rb") as found, open(expected, "rb") as wanted:
            self.assertEqual(found.read(), wanted.read())

    def test_its_user_is_nobody(self):
        with open(os.path.join(self.bundle, "config.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["process"]["user"], {"uid": 65534, "gid": 65534})

    def test_the_same_program_gives_the_same_image(self):
        again = os.path.join(self.temporary.name, "again")
        output(os.path.join(PACKAGING, "image", "oci.sh"), static_program(), again, "test")
        output("diff", "-r", self.layout, again)

    def test_the_recipe_for_docker_has_the_same_entry_point_and_user(self):
        need("buildah")
        work = os.path.join(self.temporary.name, "buildah")
        context = os.path.join(work, "context")
        output(os.path.join(PACKAGING, "image", "root.sh"), static_program(), context)
        buildah = ["buildah", "--storage-driver", "vfs", "--root", f"{work}/root", "--runroot", f"{work}/run"]
        file = os.path.join(PACKAGING, "image", "Dockerfile")
        if run(*buildah, "bud", "--isolation", "chroot", "-f", file, "-t", "halflit", context).returncode:
            raise unittest.SkipTest("buildah cannot work here")
        image = json.loads(output(*buildah, "inspect", "--type", "image", "halflit"))["OCIv1"]["config"]
        self.assertEqual((image["Entrypoint"], image["User"], image["WorkingDir"]), (["/halflit"], "65534:65534", "/work"))


if __name__ == "__main__":
    main()
