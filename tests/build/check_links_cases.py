"""The link check finds what is broken and accepts what GitHub shows as a working link."""
import contextlib
import io
import subprocess
import tempfile
import unittest
from pathlib import Path

import check_links

PAGE = """# The *page*

## Files and `folders`
## What it is: V & r, "Ta" (kPa)
## Twice
## Twice
<a id="own"></a>
```sh
# not a heading
```
"""


class Links(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.write("README.md", PAGE)
        self.write("room/README.md", "# room\n\n## Inside\n")
        self.write("room/code.cpp", "int main() {}\n")
        self.write("room/picture.png", "")

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def problems(self, text, name="room/page.md"):
        self.write(name, text)
        return list(check_links.Project(self.root).problems())

    def accepts(self, text):
        self.assertEqual(self.problems(text), [], text)

    def rejects(self, text, complaint):
        problems = self.problems(text)
        self.assertEqual(len(problems), 1, f"{text}: {problems}")
        self.assertIn(complaint, problems[0])

    def test_files_and_folders(self):
        self.accepts("[a](README.md) [b](../README.md) [c](code.cpp) [d](../room/) [e](..) ![f](picture.png)")
        self.accepts("[a](code.cpp#L1) [b](code.cpp#L1-L2) [c](README.md \"a title\") [d](<README.md>)")
        self.accepts("[a](https://nowhere.invalid/x.md#y) [b](mailto:a@b.c)")
        self.accepts("[![picture in a link](picture.png)](README.md)")
        self.accepts("[a]: README.md")
        self.rejects("one\n\n[a](missing.md)", "room/page.md:3: missing.md: there is no file room/missing.md")
        self.rejects("![a](missing.png)", "no file room/missing.png")
        self.rejects("[a\nb](missing.md)", "room/page.md:2: missing.md")
        self.rejects("[a](Code.cpp)", "no file room/Code.cpp")
        self.rejects("[a](README.md) and [b](missing.md)", "missing.md")
        self.rejects("[![picture in a link](missing.png)](README.md)", "missing.png")
        self.rejects("[![picture in a link](picture.png)](missing.md)", "missing.md")
        self.rejects("[a]: missing.md", "missing.md")
        self.rejects("<img src=\"missing.png\">", "missing.png")
        self.rejects("[a](/README.md)", "starts with /")
        self.rejects("[a](../../README.md)", "leaves the project")

    def test_anchors(self):
        self.accepts("# Own\n[a](#own) [b](README.md#inside) [c](../README.md#files-and-folders) [d](../room#inside)")
        self.accepts("[a](../README.md#what-it-is-v--r-ta-kpa) [b](../README.md#twice-1) [c](../README.md#own)")
        self.accepts("[a](../README.md#the-page)")
        self.rejects("[a](#own)", "room/page.md has no heading #own")
        self.rejects("[a](README.md#outside)", "room/README.md has no heading #outside")
        self.rejects("[a](README.md#Inside)", "no heading #Inside")
        self.rejects("[a](../README.md#twice-2)", "no heading #twice-2")
        self.rejects("[a](../README.md#not-a-heading)", "no heading #not-a-heading")
        self.rejects("[a](code.cpp#main)", "room/code.cpp has no headings")

    def test_code_holds_no_links(self):
        self.accepts("```\n[a](missing.md)\n```\ntext `[a](missing.md)`\n\n    [a](missing.md)\n\n    [b](missing.md)\n")
        self.rejects("```\n[a](missing.md)\n```\n[b](lost.md)", "room/page.md:4: lost.md")
        self.rejects("- item\n    [a](missing.md)", "room/page.md:2: missing.md")

    def test_files_that_texts_name(self):
        self.write("room/more.cpp", "// See room/README.md, else/README.md, build/x/room/lost.md and ${root}/room/lost.md.\n")
        self.accepts("`room/code.cpp`\n\n    run room/code.cpp --out room/new\n")
        self.rejects("`room/lost.cpp`", "room/page.md:1: room/lost.cpp: there is no such file")
        self.rejects("text\n\n    run room/lost.toml\n", "room/page.md:3: room/lost.toml: there is no such file")
        self.write("room/more.cpp", "// See\n// room/lost.md.\n")
        self.rejects("", "room/more.cpp:2: room/lost.md: there is no such file")

    def test_a_file_that_git_ignores_is_missing_in_a_clone(self):
        subprocess.run(["git", "init", "--quiet", self.root], check=True)
        self.write(".gitignore", "/left_out/\n")
        self.write("left_out/page.md", "[a](missing.md)")
        self.accepts("[a](README.md)")
        self.rejects("[a](../left_out/page.md)", "no file left_out/page.md")

    def test_the_exit_status(self):
        with contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(check_links.main(self.root), 0)
            self.write("room/page.md", "[a](missing.md)")
            self.assertEqual(check_links.main(self.root), 1)
        with tempfile.TemporaryDirectory() as empty, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(check_links.main(empty), 1)


if __name__ == "__main__":
    unittest.main()
