"""check_sizes.py ROOT: no file and no function of the production code, and no README, is longer than the limits below.

A function's lines are those from the first of its declaration to its closing brace, without the comment above it; a
lambda or a local class belongs to the function that it stands in. The lengths are taken from the text, which
clang-format has laid out.
"""
import re
import sys
from pathlib import Path

from project_files import project_files

PRODUCTION = ("kernels", "solver", "apps", "bench")
LIMITS = {"source": 400, "header": 300, "function": 60, "main README": 150, "README": 120}

TOKEN = re.compile(r"""
    (?P<comment> //[^\n]*(?:\\\n[^\n]*)* | /\*.*?\*/ )
  | (?P<raw> \b(?:u8|[uUL])?R"(?P<delimiter>[^()\\\s]*)\(.*?\)(?P=delimiter)" )
  | (?P<string> "(?:\\.|[^"\\\n])*" )
  | (?P<character> (?<![0-9a-fA-F])'(?:\\.|[^'\\\n])*' )
  | (?P<directive> ^[ \t]*\#(?:[^\n\\]|\\.)* )
""", re.VERBOSE | re.DOTALL | re.MULTILINE)

SCOPE = re.compile(r"\b(?:namespace|class|struct|union|enum)\b[^=]*\Z|\bextern\s*\"[^\"]*\"\s*\Z")
LAMBDA = re.compile(r"\[[^\[\]]*\]\s*(?:\([^{}]*\)[^(){}]*)?\Z")
LABEL = re.compile(r"\s*(?:public|protected|private):")
NAME = re.compile(r"(operator\s*(?:\(\)|[^\s\w(]+|\w+)|(?:\w+(?:<[^<>()]*>)?::)*~?\w+)\s*\(")
NOT_NAMES = {"alignas", "decltype", "explicit", "noexcept", "requires"}


def blanked(text):
    """The text with comments, preprocessor lines and the insides of literals as spaces; every line stays a line."""
    def blank(match):
        inside = re.sub(r"[^\n]", " ", match[0])
        return f'"{inside[1:-1]}"' if match["string"] or match["raw"] else inside
    return TOKEN.sub(blank, text)


def names_called(declaration):
    """Names before parentheses; that of a function first."""
    return [re.sub(r"\s", "", name) for name in NAME.findall(declaration) if name not in NOT_NAMES]


def kind_of(declaration):
    """What the brace after this text opens: a "scope" (namespace, type), the body of a "function" or something "else"."""
    if SCOPE.search(declaration) and not names_called(declaration):
        return "scope"
    if LAMBDA.search(declaration):
        return "function"
    flat = declaration
    while (shorter := re.sub(r"\([^()]*\)", "", flat)) != flat:
        flat = shorter
    has_parameters = flat != declaration and not re.search(r"[()]", flat)
    # clang-format leaves no space before the braces of a value: `count_{n}`.
    value = not declaration[-1].isspace() or re.search(r"(?:[=,]|\breturn)\s*\Z", declaration)
    return "function" if has_parameters and not value else "else"


def functions(text):
    """(name, first line, number of lines) of each function that does not stand in another one."""
    text = blanked(text)
    found, stack, start = [], [], 0  # `start`: where the declaration begins that is being read
    for brace in re.finditer(r"[{};]", text):
        at = brace.start()
        in_function = any(kind == "function" for kind, _ in stack)
        if brace[0] == "{":
            kind = "else" if in_function else kind_of(text[start:at])
            stack.append((kind, start))
        elif brace[0] == "}":
            if not stack:
                raise ValueError("a closing brace too many")
            kind, began = stack.pop()
            if kind == "function":
                label = LABEL.match(text, began)
                first = re.compile(r"\S").search(text, label.end() if label else began).start()
                line = text.count("\n", 0, first) + 1
                name = (names_called(text[first:at]) or ["lambda"])[0]
                found.append((name, line, text.count("\n", first, at) + 1))
        if brace[0] == ";":
            ended = not stack or stack[-1][0] != "else"
        else:
            ended = kind == "scope" or (brace[0] == "}" and kind == "function")
        if ended:
            start = at + 1
    if stack:
        raise ValueError("a closing brace is missing")
    return found


def measures(root):
    """(place, kind, length) of everything that has a limit."""
    for name in project_files(root):
        folders = name.split("/")
        if folders[-1] == "README.md":
            yield name, "README" if len(folders) > 1 else "main README", lines_of(root / name)
        if folders[0] not in PRODUCTION or not name.endswith((".cpp", ".hpp")):
            continue
        text = (root / name).read_text(encoding="utf-8")
        yield name, "source" if name.endswith(".cpp") else "header", text.count("\n")
        try:
            found = functions(text)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error
        for function, line, length in found:
            yield f"{name}:{line}: {function}", "function", length


def lines_of(path):
    return path.read_text(encoding="utf-8").count("\n")


def problems(root):
    measured = list(measures(root))
    for place, kind, length in measured:
        if length > LIMITS[kind]:
            yield f"{place}: {length} lines; a {kind} has at most {LIMITS[kind]}"
    if not measured:
        yield "there is nothing to measure"


def main(root):
    found = list(problems(Path(root)))
    print("\n".join(found + [f"{len(found)} problems"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
