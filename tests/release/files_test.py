"""Files of `./dev release --source-only`."""
import hashlib
import json
import os
import re
import tarfile
import tempfile
import unittest

from common import PACKAGING, PROGRAM, ROOT, main, need, output, run, text_of


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        need("git", "bash")
        if run("git", "-C", ROOT, "rev-parse", "HEAD").returncode:
            raise unittest.SkipTest("the source is not a clone")
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = os.path.join(cls.temporary.name, "release")
        output(os.path.join(PACKAGING, "release.sh"), "--source-only", "--dirty", cls.folder)
        cls.version = output(os.path.join(PACKAGING, "versions.py"), ROOT).strip()

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_checksums_are_those_of_all_files(self):
        sums = dict(reversed(line.split("  ")) for line in text_of(self.folder, "SHA256SUMS").splitlines())
        self.assertEqual(sorted(sums), sorted(set(os.listdir(self.folder)) - {"SHA256SUMS"}))
        for name, expected in sums.items():
            with open(os.path.join(self.folder, name), "rb") as file:
                self.assertEqual(hashlib.sha256(file.read()).hexdigest(), expected, name)

    def test_the_source_is_the_last_commit(self):
        with tarfile.open(os.path.join(self.folder, f"halflit-{self.version}.tar.gz")) as tar:
            names = {name for name in tar.getnames() if not tar.getmember(name).isdir()}
        committed = output("git", "-C", ROOT, "ls-tree", "-r", "-z", "--name-only", "HEAD").split("\0")
        self.assertEqual(names, {f"halflit-{self.version}/{name}" for name in committed if name})

    def test_a_second_run_makes_the_same_files_in_the_same_folder(self):
        before = text_of(self.folder, "SHA256SUMS")
        output(os.path.join(PACKAGING, "release.sh"), "--source-only", "--dirty", self.folder)
        self.assertEqual(text_of(self.folder, "SHA256SUMS"), before)

    def test_other_files_in_the_folder_are_not_touched(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "mine.txt")
            with open(path, "w", encoding="utf-8") as file:
                file.write("mine")
            self.assertNotEqual(run(os.path.join(PACKAGING, "release.sh"), "--source-only", "--dirty", folder).returncode, 0)
            self.assertEqual(os.listdir(folder), ["mine.txt"])

    def test_hashes_of_commands_are_those_of_the_program(self):
        rows = re.findall(r"^([0-9a-f]{16})  halflit (render .*)$", text_of(self.folder, "hashes.txt"), re.M)
        self.assertGreaterEqual(len(rows), 6)
        for digits, command in rows:
            report = output(PROGRAM, *command.split(), "-o", os.path.join(self.temporary.name, "a.png"), "--report", "-")
            self.assertIn(f'"pixel_hash": "{digits}"', report, command)

    def test_hashes_of_the_golden_scenes_are_all_there(self):
        golden = [line.split() for line in text_of(ROOT, "tests", "golden", "hashes.txt").splitlines() if not line.startswith("#")]
        text = text_of(self.folder, "hashes.txt")
        self.assertGreater(len(golden), 100)
        for name, codes, linear in golden:
            self.assertIn(f"\n{codes.zfill(16)}  {linear.zfill(16)}  {name}\n", text)

    def test_the_parts_of_a_program_are_listed(self):
        document = json.loads(output(os.path.join(PACKAGING, "sbom.py"), PROGRAM))
        lines = output(PROGRAM, "--version", "--verbose").splitlines()
        self.assertEqual([package["name"] for package in document["packages"]], [line.split()[0] for line in lines])
        self.assertIn("libdeflate", [package["name"] for package in document["packages"]])
        known = {package["SPDXID"] for package in document["packages"]} | {"SPDXRef-DOCUMENT"}
        for relation in document["relationships"]:
            self.assertLessEqual({relation["spdxElementId"], relation["relatedSpdxElement"]}, known)

    def test_a_key_signs_the_checksums(self):
        need("ssh-keygen")
        with tempfile.TemporaryDirectory() as folder:
            key = os.path.join(folder, "key")
            output("ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", key)
            made = os.path.join(folder, "release")
            output(os.path.join(PACKAGING, "release.sh"), "--source-only", "--dirty", made, env={**os.environ, "HALFLIT_SIGNING_KEY": key})
            done = run("ssh-keygen", "-Y", "check-novalidate", "-n", "file", "-s", os.path.join(made, "SHA256SUMS.sig"),
                       input=text_of(made, "SHA256SUMS"))
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_notes_are_the_changes_of_this_version(self):
        notes = text_of(self.folder, "notes.md")
        self.assertTrue(notes.startswith(f"## {self.version} ("))
        self.assertEqual(notes.count("\n## "), 0)
        self.assertIn(notes, text_of(ROOT, "CHANGELOG.md"))


if __name__ == "__main__":
    main()
