"""The step of the action and the hooks, run as their hosts run them."""
import json
import os
import re
import shutil
import tempfile
import unittest

from common import PACKAGING, PROGRAM, ROOT, main, need, output, run, text_of

KNOT = os.path.join(ROOT, "apps", "examples", "knot.glb")
BOX = """OFF
8 6 0
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 {top}
4 3 2 1 0
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


class Action(unittest.TestCase):
    def setUp(self):
        need("git", "bash")
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.repository = os.path.join(self.temporary.name, "repository")
        self.git("init", "-q", "-b", "main", self.repository, folder=self.temporary.name)
        write(self.file("parts", "a box.off"), BOX.format(top=1))
        write(self.file("pictures", "golden.json"), json.dumps({
            "schema": "halflit.golden-list/1",
            "scenes": [{"name": "ball", "scene": "sphere:200", "flags": ["--size", "32x32"]}],
        }))
        output(PROGRAM, "golden", "update", "pictures", cwd=self.repository)
        self.commit()
        self.report = os.path.join(self.temporary.name, "report")

    def file(self, *path):
        return os.path.join(self.repository, *path)

    def git(self, *arguments, folder=None):
        names = {f"GIT_{role}_{what}": "test@invalid" for role in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
        return output("git", *arguments, cwd=folder or self.repository, env={**os.environ, **names})

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "change")

    def check(self, **variables):
        """Runs the step with GitHub's files. Returns the process, the summary and the outputs."""
        files = {name: os.path.join(self.temporary.name, name) for name in ("GITHUB_STEP_SUMMARY", "GITHUB_OUTPUT")}
        for path in files.values():
            write(path, "")
        done = run(os.path.join(PACKAGING, "action", "check.sh"), cwd=self.repository,
                   env={**os.environ, **files, "HALFLIT_PROGRAM": PROGRAM, "HALFLIT_REPORT": self.report, **variables})
        outputs = dict(line.split("=", 1) for line in text_of(files["GITHUB_OUTPUT"]).splitlines())
        return done, text_of(files["GITHUB_STEP_SUMMARY"]), outputs

    def test_expected_pictures_pass(self):
        done, summary, outputs = self.check(HALFLIT_GOLDEN="pictures")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(outputs["passed"], "true")
        self.assertIn("**`pictures`**: every picture is as expected.", summary)
        self.assertEqual(text_of(outputs["comment"]), summary)

    def test_another_picture_fails_and_its_page_is_there(self):
        text = text_of(self.file("pictures", "golden.json"))
        write(self.file("pictures", "golden.json"), text.replace("sphere:200", "sphere:80"))
        done, summary, outputs = self.check(HALFLIT_GOLDEN="pictures")
        self.assertEqual((done.returncode, outputs["passed"]), (1, "false"))
        self.assertIn("differs", summary)
        self.assertIn("ball", summary)
        self.assertIn("ball-difference.png", os.listdir(os.path.join(self.report, "golden", "pictures")))
        self.assertIn("ball", text_of(self.report, "golden", "pictures", "index.html"))

    def test_a_list_that_cannot_be_read_fails_with_its_message(self):
        write(self.file("pictures", "golden.json"), "{")
        done, summary, _ = self.check(HALFLIT_GOLDEN="pictures")
        self.assertEqual(done.returncode, 1)
        self.assertIn("halflit: error:", summary)

    def test_models_that_changed_are_compared_and_fail_only_if_asked(self):
        base = self.git("rev-parse", "HEAD").strip()
        write(self.file("parts", "a box.off"), BOX.format(top=1.5))
        self.commit()
        for fail, code in (("false", 0), ("true", 1)):
            done, summary, _ = self.check(HALFLIT_BASE=base, HALFLIT_FAIL_ON_CHANGE=fail, HALFLIT_COMPARE_FLAGS="--size 64x64")
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn("**`parts/a box.off`**", summary)
            self.assertNotIn("![", summary)  # a summary cannot show the files of an artifact
            self.assertIn("1.5", summary)  # the size that changed
        folder = os.listdir(os.path.join(self.report, "models", "parts", "a box.off"))
        self.assertLessEqual({"index.html", "compare.png"}, set(folder))

    def test_names_of_files_are_no_flags_and_no_markdown(self):
        names = ("-x.off", "--markdown=e.off", "<img src=a>`@me`[a](b).off")
        for name in names:
            write(self.file(".", name), BOX.format(top=1))
        self.commit()
        base = self.git("rev-parse", "HEAD").strip()
        for name in names:
            write(self.file(".", name), BOX.format(top=1.5))
        self.commit()
        done, summary, _ = self.check(HALFLIT_BASE=base, HALFLIT_COMPARE_FLAGS="--size 32x32")
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in names:
            self.assertIn("**`" + name.replace("`", "'") + "`**", summary)
        self.assertEqual(sorted(os.listdir(os.path.join(self.report, "models"))), sorted(names))
        self.assertFalse(os.path.exists(self.file("e.off")))

    def test_without_a_change_there_is_nothing_to_compare(self):
        done, summary, _ = self.check(HALFLIT_BASE="HEAD")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("no model that changed", summary)

    def test_a_base_that_was_not_fetched_is_named(self):
        done, _, _ = self.check(HALFLIT_BASE="0" * 40)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no such commit here", done.stderr)

    def test_inputs_of_the_action_are_those_that_its_steps_use(self):
        need("ruby")
        read = "puts JSON.dump(YAML.load(STDIN.read))"
        action = json.loads(output("ruby", "-ryaml", "-rjson", "-e", read, input=text_of(ROOT, "action.yml")))
        used = set(re.findall(r"inputs\.([a-z-]+)", json.dumps(action["runs"])))
        self.assertEqual(used, set(action["inputs"]))
        script = text_of(PACKAGING, "action", "check.sh")
        step = next(step for step in action["runs"]["steps"] if step.get("id") == "check")
        for name in step["env"]:
            self.assertIn(f"${{{name}", script)
        for value in action["outputs"].values():
            self.assertIn(re.search(r"outputs\.(\w+)", value["value"]).group(1) + "=", script)


class Hooks(unittest.TestCase):
    def setUp(self):
        need("bash")
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.damaged = os.path.join(self.temporary.name, "damaged.glb")
        with open(KNOT, "rb") as whole, open(self.damaged, "wb") as cut:
            cut.write(whole.read()[:-100])

    def lint(self, *models):
        return run(os.path.join(PACKAGING, "hooks", "lint_models.sh"), *models, cwd=self.temporary.name,
                   env={**os.environ, "HALFLIT_PROGRAM": PROGRAM})

    def test_a_sound_model_passes_and_says_nothing(self):
        shutil.copy(KNOT, os.path.join(self.temporary.name, "-knot.glb"))
        done = self.lint(KNOT, "-knot.glb")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_a_damaged_model_is_named(self):
        done = self.lint(KNOT, self.damaged, KNOT)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"^halflit: error: .*damaged\.glb: .*\n$")

    def test_the_entries_of_the_hooks_are_there(self):
        need("ruby")
        hooks = json.loads(output("ruby", "-ryaml", "-rjson", "-e", "puts JSON.dump(YAML.load(STDIN.read))",
                                  input=text_of(ROOT, ".pre-commit-hooks.yaml")))
        self.assertEqual([hook["id"] for hook in hooks], ["halflit-golden", "halflit-lint"])
        self.assertTrue(os.access(os.path.join(ROOT, hooks[1]["entry"]), os.X_OK))
        for name in ("a.glb", "b.GLTF".lower(), "c.stl", "d.ply", "e.obj", "f.3mf", "g.off"):
            self.assertRegex(name, hooks[1]["files"])
        self.assertIsNone(re.search(hooks[1]["files"], "picture.png"))


if __name__ == "__main__":
    main()
