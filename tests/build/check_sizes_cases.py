"""The size check measures each kind of function, and finds what is too long."""
import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import check_sizes

SOURCE = '''// A file { with ( braces in comments
#include <vector>
#define OPEN {
namespace a::b {
namespace {

constexpr std::array names = {
    Name{"a {", '{'},
    Name{"b", '\\''},
};
const std::vector<int> more = make(3, {1, 2});
int large = 1'000'000;
const char* const text = R"css(
body { color: red;
)css";

struct alignas(16) Point {
  double x = 0, y{};
  double length() const { return x; }
};

}  // namespace

Solver::Solver(int n, double tolerance)
    : n_(n), values_{1, 2}, tolerance_(tolerance) {
  for (int i = 0; i < n; ++i) {
    values_.push_back(i);
  }
}

// A comment is not counted.
template <class Real, class = std::enable_if_t<true>>
  requires std::is_floating_point_v<Real>
[[nodiscard]] Real
largest(const View<Real>& view) noexcept {
  struct Local {
    Real x;
    Real get() {
      return x;
    }
  };
  const auto get = [&](int i) {
    return view(i);
  };
  return Local{get(0)}.get();
}

bool operator==(const Point& a, const Point& b) {
  return a.x == b.x;
}

class Solver {
 public:
  void operator()(int i) const {
    run(i);
  }

 private:
  std::vector<int> values_{1, 2};
  ~Solver() {
  }
  struct Inner {
    auto get() const -> std::pair<int, int> { return {1, 2}; }
  };
  enum class Kind { one, two };
};

const auto scale = [](double x) {
  return 2 * x;
};

}  // namespace a::b
extern "C" {
int main() {
  return 0;
}
}
'''


class Functions(unittest.TestCase):
    def test_each_kind(self):
        expected = [("length", 1), ("Solver::Solver", 6), ("largest", 15), ("operator==", 3), ("operator()", 3),
                    ("~Solver", 2), ("get", 1), ("lambda", 3), ("main", 3)]
        self.assertEqual([(name, length) for name, _, length in check_sizes.functions(SOURCE)], expected)

    def test_where_it_starts(self):
        lines = SOURCE.split("\n")
        starts = {name: lines[line - 1] for name, line, _ in check_sizes.functions(SOURCE)}
        self.assertEqual(starts["Solver::Solver"], "Solver::Solver(int n, double tolerance)")
        self.assertTrue(starts["largest"].startswith("template <class Real"))
        self.assertEqual(starts["operator()"].strip(), "void operator()(int i) const {")

    def test_braces_that_do_not_match(self):
        for text in ("int f() {\n", "}\n"):
            with self.assertRaises(ValueError):
                check_sizes.functions(text)


class Sizes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.write("README.md", 150)
        self.write("apps/README.md", 120)
        self.write("room/REFERENCE.md", 1000)
        self.write("tests/unit/long.cpp", 1000)
        self.write("solver/run.cpp", 400)
        self.write("solver/run/run.hpp", 300)
        self.function(60)

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name, lines):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("// line\n" * lines)

    def function(self, lines):
        self.write("bench/main.cpp", 3)
        with open(self.root / "bench/main.cpp", "a", encoding="utf-8") as file:
            file.write("int main() {\n" + "  f();\n" * (lines - 2) + "}\n")

    def expect(self, *complaints):
        found = list(check_sizes.problems(self.root))
        self.assertEqual(len(found), len(complaints), found)
        for complaint, one in zip(complaints, found):
            self.assertIn(complaint, one)

    def test_what_is_at_its_limit_passes(self):
        self.expect()

    def test_what_is_over_it_fails(self):
        for name, lines in (("README.md", 151), ("apps/README.md", 121), ("solver/run.cpp", 401),
                            ("solver/run/run.hpp", 301)):
            self.write(name, lines)
            self.expect(f"{name}: {lines} lines; ")
            self.write(name, lines - 1)
        self.function(61)
        self.expect("bench/main.cpp:4: main: 61 lines; a function has at most 60")

    def test_an_empty_project_fails(self):
        with tempfile.TemporaryDirectory() as empty, contextlib.redirect_stdout(io.StringIO()):
            self.assertEqual(list(check_sizes.problems(Path(empty))), ["there is nothing to measure"])
            self.assertEqual(check_sizes.main(empty), 1)


if __name__ == "__main__":
    unittest.main()
