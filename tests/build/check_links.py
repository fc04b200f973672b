"""check_links.py ROOT: every relative link of every Markdown file has its file and its heading.

Links to other sites are not followed. A link has to name a file that git tracks, since others are missing in a clone.
Wherever a text or a comment names a file by its path from the root, that file has to be there too.
"""
import re
import sys
import unicodedata
from pathlib import Path
from urllib.parse import unquote

from project_files import project_files

FENCE = re.compile(r"^ {0,3}(```+|~~~+)")
HEADING = re.compile(r"^ {0,3}(#{1,6})\s+(.*?)\s*#*\s*$")
CODE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)")
# [text](target), [text](<target>), [text](target "title"); the text may hold brackets, as of a picture that is a link.
INLINE = re.compile(r"\]\(\s*<?([^()<>\s]*(?:\([^()\s]*\)[^()<>\s]*)*)>?(?:\s+(?:\"[^\"]*\"|'[^']*'))?\s*\)")
DEFINITION = re.compile(r"^ {0,3}\[[^\]]+\]:\s*<?([^\s>]+)>?")
HTML = re.compile(r"<(?:a|img)\s[^>]*?(?:href|src)=[\"']([^\"']+)[\"']")
HTML_ANCHOR = re.compile(r"<[a-z]+\s[^>]*?(?:id|name)=[\"']([^\"']+)[\"']")
SCHEME = re.compile(r"^[A-Za-z][A-Za-z0-9+.-]*:")
TEXTS = ("md", "cpp", "hpp", "cmake", "txt", "py", "sh", "awk", "toml", "js", "css")
MENTION = re.compile(rf"(?<![\w./$}}>-])(?:[\w-]+/)+[\w-]+\.(?:{'|'.join(TEXTS)}|png|svg)\b")
CASES = "tests/build/"  # cases of checks name files that are not there


def prose(text):
    """(number, line) of the lines outside of code blocks; an indented block of code follows an empty line."""
    fence, blank, block = "", True, False
    for number, line in enumerate(text.split("\n"), 1):
        mark = FENCE.match(line)
        if fence:
            if mark and mark[1].startswith(fence):
                fence = ""
        elif mark:
            fence, block = mark[1], False
        elif line.startswith(("    ", "\t")) and (blank or block):
            block = True
        elif line.strip():
            block = False
            yield number, line
        blank = not line.strip()


def anchor(heading):
    """The anchor that GitHub gives to a heading."""
    heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
    kept = (c for c in heading.strip().lower() if c in " -_" or unicodedata.category(c)[0] in "LNM")
    return "".join(kept).replace(" ", "-")


def anchors(text):
    """Those of all headings; a repeated one has -1, -2, ... at its end."""
    found = set()
    for _, line in prose(text):
        found.update(HTML_ANCHOR.findall(line))
        heading = HEADING.match(line)
        if heading:
            name = first = anchor(heading[2])
            again = 0
            while name in found:
                again += 1
                name = f"{first}-{again}"
            found.add(name)
    return found


def links(text):
    """(line, target) of each link and picture."""
    lines = list(prose(text))
    for number, line in lines:
        line = CODE.sub("", line)
        for pattern in (INLINE, HTML):
            for target in pattern.findall(line):
                yield number, target
        definition = DEFINITION.match(line)
        if definition:
            yield number, definition[1]


def resolve(page, target):
    """Path of `target` from the root; None where it leaves the project."""
    parts = page.split("/")[:-1]
    for part in target.split("/"):
        if part == "..":
            if not parts:
                return None
            parts.pop()
        elif part not in ("", "."):
            parts.append(part)
    return "/".join(parts)


class Project:
    def __init__(self, root):
        self.root = Path(root)
        self.files = set(project_files(self.root))
        self.folders = {""} | {"/".join(name.split("/")[:n]) for name in self.files for n in range(1, name.count("/") + 1)}
        self.pages = {name: self.read(name) for name in self.files if name.endswith(".md")}
        self.anchors = {name: anchors(text) for name, text in self.pages.items()}

    def read(self, name):
        return (self.root / name).read_text(encoding="utf-8", errors="replace")

    def problem(self, page, target):
        """What is wrong with a link, or nothing."""
        if SCHEME.match(target) or target.startswith("//"):
            return ""
        path, _, heading = unquote(target).partition("#")
        if path.startswith("/"):
            return "starts with /; name it relative to this file"
        file = resolve(page, path) if path else page
        if file is None:
            return "leaves the project"
        if file not in self.files and file not in self.folders:
            return f"there is no file {file}"
        if not heading:
            return "" if path or target != "#" else "has no target"
        if file in self.folders:
            file = f"{file}/README.md".lstrip("/")
        if file not in self.anchors:
            line = re.fullmatch(r"L(\d+)(-L\d+)?", heading)
            return "" if line and file in self.files else f"{file} has no headings"
        return "" if heading in self.anchors[file] else f"{file} has no heading #{heading}"

    def problems(self):
        for page in sorted(self.pages):
            for number, target in links(self.pages[page]):
                wrong = self.problem(page, target)
                if wrong:
                    yield f"{page}:{number}: {target}: {wrong}"
        for name in sorted(self.files):
            if name.split(".")[-1] not in TEXTS or name.startswith(CASES):
                continue
            for number, line in enumerate(self.read(name).split("\n"), 1):
                for mention in MENTION.findall(line):
                    if mention not in self.files and mention.split("/")[0] in self.folders:
                        yield f"{name}:{number}: {mention}: there is no such file"


def main(root):
    project = Project(root)
    problems = list(project.problems())
    count = sum(1 for text in project.pages.values() for _ in links(text))
    print("\n".join(problems + [f"{count} links of {len(project.pages)} files, {len(problems)} broken"]))
    return 1 if problems or not project.pages else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
