"""What is not allowed is found: each package has one thing wrong.

    python3 -m unittest discover -s scripts/dependencies
"""

import unittest

import allowed

RULES = {"licenses": {"allow": ["MIT", "Apache-2.0 WITH LLVM-exception"]}, "bans": {"deny": [{"name": "bad", "reason": "a reason"}]}}


REGISTRY = "registry+https://example.org/index"


def package(**changed):
    good = {"name": "town", "version": "1.0.0", "license": "MIT", "source": REGISTRY, "dependencies": []}
    return {**good, **changed}


def left(**changed):
    return {"name": "left", "req": "*", "registry": None, **changed}


class Problems(unittest.TestCase):
    def told(self, **changed):
        return list(allowed.problems([package(**changed)], RULES))

    def test_what_is_as_the_rules_want_it_is_fine(self):
        self.assertEqual(self.told(), [])
        self.assertEqual(self.told(source=None, dependencies=[left(path="../left")]), [])

    def test_what_is_not_is_named(self):
        self.assertEqual(self.told(name="bad"), ["bad 1.0.0: is denied, for a reason"])
        self.assertIn("its licence is GPL-3.0-only", self.told(license="GPL-3.0-only")[0])
        self.assertIn("comes from git+https", self.told(source="git+https://example.org/town")[0])
        self.assertIn("takes left from sparse+", self.told(dependencies=[left(registry="sparse+https://example.org")])[0])
        self.assertIn("any version of left", self.told(source=None, dependencies=[left()])[0])

    def test_packages_of_the_registry_may_take_any_version(self):
        self.assertEqual(self.told(dependencies=[left()]), [])


class Licences(unittest.TestCase):
    def licensed(self, text):
        return allowed.licensed(text, set(RULES["licenses"]["allow"]))

    def test_one_of_several_is_enough_where_they_are_alternatives(self):
        self.assertTrue(self.licensed("GPL-3.0-only OR MIT"))
        self.assertTrue(self.licensed("MIT/Apache-2.0"))
        self.assertTrue(self.licensed("(GPL-3.0-only OR MIT) AND Apache-2.0 WITH LLVM-exception"))

    def test_all_are_needed_where_all_hold(self):
        self.assertFalse(self.licensed("MIT AND GPL-3.0-only"))
        self.assertFalse(self.licensed("(MIT OR Apache-2.0) AND Unicode-3.0"))

    def test_a_licence_without_its_exception_is_another(self):
        self.assertTrue(self.licensed("Apache-2.0 WITH LLVM-exception"))
        self.assertFalse(self.licensed("Apache-2.0"))

    def test_what_says_nothing_is_no_licence(self):
        for text in (None, "", "MIT OR", "my own"):
            self.assertFalse(self.licensed(text), text)


if __name__ == "__main__":
    unittest.main()
