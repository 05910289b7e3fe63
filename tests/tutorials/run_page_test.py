#!/usr/bin/python3
"""What run_page.py must find: numbers that are not those of a run. Pages here print by echo."""

import tempfile
import unittest
from pathlib import Path

import run_page

PAGE = """# A page

<!-- test: replace `h tall` by `h small` -->

```sh
h() {{ [ "$1" = tall ] && echo 6233 || echo 512; }}
echo "stage    seconds   value"
for p in 5 25 95; do printf '%2d %% lie below %6d m\\n' $p $(( $(h tall) * p )); done
echo "written on $(date +%Y-%m-%d) in 0.$RANDOM s by terrane 9.$RANDOM.1"
```

<!-- test: output -->
```text
...
5 % lie below  {five} m
...
95 % lie below {ninety_five} m
written on 2001-02-03 in 2.5 s by terrane 0.1.0
```
"""
RIGHT = {"five": 31165, "ninety_five": 592135}


class RunPage(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.program = self.root / "build/apps/terrane"
        self.program.parent.mkdir(parents=True)
        self.program.touch()
        run_page.EXPECTED = self.root / "expected"

    def tearDown(self):
        self.folder.cleanup()

    def run_it(self, full=False, update=False, **numbers):
        page = self.root / "page.md"
        if numbers:
            page.write_text(PAGE.format(**numbers), encoding="utf-8")
        run_page.run_page(page, self.program, self.root / "scratch", full, update)
        return page.read_text(encoding="utf-8")

    def kept(self):
        return self.root / "expected/page.txt"

    def test_right_numbers_pass_and_times_may_differ(self):
        self.run_it(full=True, **RIGHT)

    def test_a_wrong_number_of_a_page_fails_at_its_own_size(self):
        with self.assertRaisesRegex(run_page.Failure, "592135"):
            self.run_it(full=True, five=31165, ninety_five=592136)

    def test_lines_are_found_by_their_labels(self):
        with self.assertRaisesRegex(run_page.Failure, "95 % lie below 592135 m"):
            self.run_it(full=True, five=1, ninety_five=2)

    def test_update_writes_the_page_and_leaves_times_alone(self):
        updated = self.run_it(full=True, update=True, five=1, ninety_five=2)
        self.assertIn("95 % lie below 592135 m\n", updated)
        self.assertIn("5 % lie below  31165 m\n", updated)
        self.run_it(full=True)

    def test_update_of_what_is_right_changes_nothing(self):
        self.assertEqual(self.run_it(full=True, update=True, **RIGHT), PAGE.format(**RIGHT))

    def test_small_sizes_have_numbers_of_their_own(self):
        self.run_it(update=True, **RIGHT)
        self.assertIn("95 % lie below 48640 m", self.kept().read_text(encoding="utf-8"))
        self.run_it()

    def test_a_wrong_number_fails_at_the_small_size(self):
        self.run_it(update=True, **RIGHT)
        self.kept().write_text(self.kept().read_text(encoding="utf-8").replace("48640", "48641"), encoding="utf-8")
        with self.assertRaisesRegex(run_page.Failure, "48640"):
            self.run_it()

    def test_a_page_without_its_expected_numbers_fails(self):
        with self.assertRaisesRegex(run_page.Failure, "lacks this block"):
            self.run_it(**RIGHT)

    def test_other_words_fail_and_are_not_updated(self):
        page = PAGE.replace("lie below {ninety", "lie above {ninety")
        (self.root / "page.md").write_text(page.format(**RIGHT), encoding="utf-8")
        for update in (False, True):
            with self.assertRaisesRegex(run_page.Failure, "but this was printed"):
                self.run_it(full=True, update=update)


if __name__ == "__main__":
    unittest.main()
