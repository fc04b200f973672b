#include "apps/draw/figure.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "apps/base/file_io.hpp"
#include "apps/base/page.hpp"
#include "apps/draw/plot_panel.hpp"
#include "apps/draw/sheet_panel.hpp"

namespace myowave::apps {
namespace {

constexpr double panel_width = 320;  // points: 480 pixels
constexpr double figure_title_space = 26;
constexpr double with_heading = 26, without_heading = 10;  // above the axes of a panel

const std::string& title_of(const Panel& panel) {
  return std::visit([](const auto& one) -> const std::string& { return one.title; }, panel);
}

// "(a)", ... "(z)", "(aa)", ...
std::string letter(std::size_t n) {
  std::string text(1, static_cast<char>('a' + n % 26));
  for (; n >= 26; n -= 26) text += text.front();
  return "(" + text + ")";
}

std::pair<int, int> size_of(const SheetPicture& sheet) { return {sheet.shape.rows, sheet.shape.columns}; }

// Panels with their places on the page.
class Layout {
 public:
  explicit Layout(const Figure& figure)
      : figure_(figure), columns_(std::size_t(std::max(1, figure.columns))) {
    const bool headed =
        figure.panels.size() > 1 || (figure.panels.size() == 1 && !title_of(figure.panels[0]).empty());
    const double top = headed ? with_heading : without_heading;
    std::map<std::pair<int, int>, SheetExtent> extents;  // of all sheets with so many rows and columns
    for (const Panel& panel : figure.panels)
      if (const auto* sheet = std::get_if<SheetPicture>(&panel)) {
        const auto [known, is_new] = extents.try_emplace(size_of(*sheet), sheet_extent(*sheet));
        if (!is_new) known->second = joined(known->second, sheet_extent(*sheet));
      }
    for (const Panel& panel : figure.panels) {
      if (const auto* plot = std::get_if<Plot>(&panel)) {
        panels_.push_back({std::make_unique<PlotPanel>(*plot, panel_width, top), nullptr, {}});
      } else {
        const auto& sheet = std::get<SheetPicture>(panel);
        panels_.push_back(
            {nullptr, std::make_unique<SheetPanel>(sheet, extents.at(size_of(sheet)), panel_width, top), {}});
      }
    }
    place();
  }

  double width() const {
    return panel_width * double(std::min(columns_, std::max<std::size_t>(1, panels_.size())));
  }
  double height() const { return height_; }

  void draw(Canvas& canvas) const {
    if (!figure_.title.empty())
      canvas.text({0.5 * width(), 18}, figure_.title, {.size = 12, .bold = true, .align = 0.5});
    for (std::size_t n = 0; n < panels_.size(); ++n) {
      const Placed& panel = panels_[n];
      canvas.enter(panel.at);
      const Box& box = panel.plot ? panel.plot->box() : panel.sheet->box();
      canvas.text({box.x + 0.5 * box.width, 16}, title_of(figure_.panels[n]), {.size = 10, .align = 0.5});
      if (panels_.size() > 1) canvas.text({8, 16}, letter(n), {.size = 11, .bold = true});
      if (panel.plot) panel.plot->draw(canvas);
      if (panel.sheet) panel.sheet->draw(canvas);
      canvas.leave();
    }
  }

 private:
  struct Placed {
    std::unique_ptr<PlotPanel> plot;
    std::unique_ptr<SheetPanel> sheet;
    Point at;
  };

  void place() {
    double left = 0;
    for (const Placed& panel : panels_)
      if (panel.plot) left = std::max(left, panel.plot->left_margin());
    height_ = figure_.title.empty() ? 0 : figure_title_space;
    double row = 0;
    for (std::size_t n = 0; n < panels_.size(); ++n) {
      if (n % columns_ == 0) height_ += row, row = 0;
      Placed& panel = panels_[n];
      panel.at = {panel_width * double(n % columns_), height_};
      row = std::max(row, panel.plot ? panel.plot->lay_out(left) : panel.sheet->height());
    }
    height_ += row;
  }

  const Figure& figure_;
  std::size_t columns_;
  std::vector<Placed> panels_;
  double height_ = 0;
};

std::string drawn(const Figure& figure, Canvas::Format format) {
  const Layout layout(figure);
  Canvas canvas(format, layout.width(), layout.height());
  layout.draw(canvas);
  return canvas.content();
}

}  // namespace

std::string figure_svg(const Figure& figure) {
  std::string svg = drawn(figure, Canvas::Format::svg);
  std::string title = figure.title;
  for (const Panel& panel : figure.panels)
    if (!title_of(panel).empty()) title += (title.empty() ? "" : "; ") + title_of(panel);
  const auto inside = svg.find('>', svg.find("<svg")) + 1;
  return svg.insert(inside, "\n<title>" + html_escape(title) + "</title>");
}

std::string figure_png(const Figure& figure) { return drawn(figure, Canvas::Format::png); }

void write_figure(const Figure& figure, const std::filesystem::path& stem) {
  for (const auto& [ending, content] :
       {std::pair{".png", figure_png(figure)}, {".svg", figure_svg(figure)}}) {
    std::filesystem::path file = stem;
    file += ending;
    replace_file(file, content);
  }
}

}  // namespace myowave::apps
