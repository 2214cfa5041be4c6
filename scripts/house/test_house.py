"""The checks find what they are for: each is shown a project with one thing wrong.

    python3 -m unittest discover -s scripts/house
"""

import tempfile
import unittest
from pathlib import Path

import circles
import pages
import sizes

MANIFEST = '[package]\nname = "town"\n'


class Project(unittest.TestCase):
    """A project of one crate in a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        self.write("crates/town/Cargo.toml", MANIFEST)
        self.write("crates/town/src/lib.rs", "pub mod left;\npub mod right;\npub use left::Left;\n")
        self.write("crates/town/src/left.rs", "use crate::right::Right;\npub struct Left(Right);\n")
        self.write("crates/town/src/right.rs", "pub struct Right;\n")

    def write(self, name, text):
        file = self.root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def circles(self, parents=False):
        return list(circles.problems(self.root, parents))


class Circles(Project):
    def test_one_direction_is_fine(self):
        self.assertEqual(self.circles(), [])

    def test_two_modules_that_use_each_other_are_a_circle(self):
        for text in (
            "use crate::left::Left;\n",
            "use super::left;\nfn f() -> left::Left { todo!() }\n",
            "use crate::{left::{Left}};\n",
            "fn f() -> crate::left::Left { todo!() }\n",
            # The parent passes it on: it is still the sibling's.
            "use crate::Left;\n",
            "use super::Left as Other;\n",
        ):
            self.write("crates/town/src/right.rs", "pub struct Right;\n" + text)
            [circle] = self.circles()
            self.assertIn("circle in town: left -> right -> left", circle, text)
            self.assertIn("town::right -> town::left   (crates/town/src/right.rs:2)", circle, text)

    def test_what_is_no_code_of_the_program_makes_no_circle(self):
        for text in (
            "// use crate::left::Left;\n",
            'const TEXT: &str = "use crate::left::Left;";\n',
            "#[cfg(test)]\nmod tests {\n    use crate::left::Left;\n}\n",
            "use std::left::Left;\n",
        ):
            self.write("crates/town/src/right.rs", "pub struct Right;\n" + text)
            self.assertEqual(self.circles(), [], text)

    def test_a_circle_of_rooms_needs_no_circle_of_files(self):
        self.write("crates/town/src/left.rs", "pub mod a;\npub mod b;\npub struct Left;\n")
        self.write("crates/town/src/left/a.rs", "use crate::right::Right;\n")
        self.write("crates/town/src/left/b.rs", "pub struct B;\n")
        self.write("crates/town/src/right.rs", "use crate::left::b::B;\npub struct Right(B);\n")
        [circle] = self.circles()
        self.assertIn("town::left::a -> town::right", circle)
        self.assertIn("town::right -> town::left::b", circle)

    def test_a_child_may_use_its_parents_own_code_unless_that_is_asked_for(self):
        self.write("crates/town/src/left.rs", "mod a;\npub struct Left;\nfn f() { a::g() }\n")
        self.write("crates/town/src/left/a.rs", "use super::Left;\npub fn g() {}\n")
        self.assertEqual(self.circles(), [])
        [circle] = self.circles(parents=True)
        self.assertIn("circle in town::left", circle)

    def test_crates_that_need_each_other_are_a_circle(self):
        self.write("crates/town/Cargo.toml", MANIFEST + '[dependencies]\nroad = { path = "../road" }\n')
        self.write("crates/road/Cargo.toml", '[package]\nname = "road"\n[dev-dependencies]\ntown = {}\n')
        self.assertEqual(self.circles(), [])
        self.write("crates/road/Cargo.toml", '[package]\nname = "road"\n[dependencies]\ntown.workspace = true\n')
        self.assertEqual(self.circles(), ["circle of crates: road -> town -> road"])


class Sizes(Project):
    def problems(self, text):
        self.write("crates/town/src/right.rs", "pub struct Right;\n" + text)
        return list(sizes.problems(self.root))

    def test_files_functions_and_lines_have_a_limit(self):
        self.assertEqual(self.problems("fn f() {\n" + "    g();\n" * 38 + "}\n"), [])
        [function] = self.problems("fn f() {\n" + "    g();\n" * 39 + "}\n")
        self.assertIn("right.rs:2: `f` has 41 lines, at most 40", function)
        [file] = self.problems("const A: u8 = 0;\n" * 300)
        self.assertIn("right.rs: 301 lines, at most 300", file)
        [line] = self.problems("// " + "ä" * 118 + "\n")
        self.assertIn("right.rs:2: 121 columns, at most 120", line)

    def test_comments_blank_lines_and_tests_do_not_count(self):
        tests = "#[cfg(test)]\nmod tests {\n" + "    const A: u8 = 0;\n" * 300 + "}\n"
        self.assertEqual(self.problems("// a comment\n\n" * 300 + tests), [])
        self.write("crates/town/tests/all.rs", "const A: u8 = 0;\n" * 400)
        self.assertEqual(self.problems(""), [])


class Pages(Project):
    def setUp(self):
        super().setUp()
        self.write("docs/method.md", "## 3 Mismatch\n\n| (4) | `town::left::Left::new` |\n")
        self.write("crates/town/src/left.rs", "pub struct Left;\nimpl Left {\n    pub fn new() -> Self { Left }\n}\n")

    def problems(self, comment):
        self.write("crates/town/src/right.rs", f"// {comment}\npub struct Right;\n")
        return list(pages.problems(self.root))

    def test_references_that_lead_somewhere_are_fine(self):
        for comment in ("docs/method.md, section 3", "docs/method.md 3", "equation (4)", "const FORMATS: [u8; 2]"):
            self.assertEqual(self.problems(comment), [], comment)

    def test_references_that_lead_nowhere_are_named(self):
        for comment, reason in (
            ("METHOD 3", "isn't in the project"),
            ("FORMATS 1.2", "isn't in the project"),
            ("eq. priorization_x", "isn't in the project"),
            ("tab:conf_mat", "isn't in the project"),
            ("docs/methods.md", "there is no page docs/methods.md"),
            ("docs/method.md, section 4", "docs/method.md has no section 4"),
        ):
            [problem] = self.problems(comment)
            self.assertIn(reason, problem)
            self.assertIn("right.rs:1", problem)

    def test_links_and_headings_are_looked_up(self):
        self.write("README.md", "[a](docs/method.md#3-mismatch) [b](https://example.org/x)\n")
        self.assertEqual(self.problems(""), [])
        self.write("README.md", "[a](docs/method.md#4-more)\n[b](docs/nothing.md)\n")
        nothing = [problem.split(": ", 1)[1] for problem in self.problems("")]
        self.assertIn("method.md has no heading #4-more", nothing)
        self.assertIn("there is no docs/nothing.md", nothing)

    def test_the_table_of_functions_is_true(self):
        for path in ("town::left::new_one", "town::left::Right::new", "town::middle::new", "town::left"):
            self.write("docs/method.md", f"| (4) | `{path}` |\n")
            self.assertEqual(self.problems(""), [f"docs/method.md:1: there is no `{path}`"])


if __name__ == "__main__":
    unittest.main()
