#include "apps/xdmf_file.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace myowave::apps {
namespace {

constexpr std::string_view head =
    "<?xml version=\"1.0\" ?>\n"
    "<Xdmf Version=\"2.0\">\n"
    " <Domain>\n"
    "  <Grid Name=\"sheet\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
constexpr std::string_view tail =
    "  </Grid>\n"
    " </Domain>\n"
    "</Xdmf>\n";

}  // namespace

XdmfFile::XdmfFile(const std::filesystem::path& path, const FrameShape& shape, std::string fields_name)
    : shape_(shape), fields_name_(std::move(fields_name)), file_(path, fmt::format("{}{}", head, tail)) {}

// One frame of a dataset. The dataset grows; its size is given as it is with this frame.
std::string XdmfFile::slab(const char* dataset, const char* precision, bool vector, std::size_t frame) const {
  const auto shape = fmt::format("{} {}{}", shape_.rows, shape_.columns, vector ? " 2" : "");
  const std::string_view zeros = vector ? "0 0 0" : "0 0";
  const std::string_view ones = vector ? "1 1 1" : "1 1";
  return fmt::format(
      "     <DataItem ItemType=\"HyperSlab\" Dimensions=\"{}\" Type=\"HyperSlab\">\n"
      "      <DataItem Dimensions=\"3 {}\" Format=\"XML\">{} {} 1 {} 1 {}</DataItem>\n"
      "      <DataItem Dimensions=\"{} {}\" NumberType=\"Float\" Precision=\"{}\" "
      "Format=\"HDF\">{}:/{}</DataItem>\n"
      "     </DataItem>\n",
      shape, vector ? 4 : 3, frame, zeros, ones, shape, frame + 1, shape, precision, fields_name_, dataset);
}

void XdmfFile::append(std::size_t frame, double t) {
  std::string text =
      fmt::format("   <Grid Name=\"frame {}\" GridType=\"Uniform\">\n    <Time Value=\"{}\"/>\n", frame, t);
  if (shape_.deforms()) {
    text += fmt::format(
        "    <Topology TopologyType=\"2DSMesh\" Dimensions=\"{} {}\"/>\n"
        "    <Geometry GeometryType=\"XY\">\n{}    </Geometry>\n",
        shape_.rows, shape_.columns, slab("grid", "4", true, frame));
  } else {
    text += fmt::format(
        "    <Topology TopologyType=\"2DCoRectMesh\" Dimensions=\"{} {}\"/>\n"
        "    <Geometry GeometryType=\"ORIGIN_DXDY\">\n"
        "     <DataItem Dimensions=\"2\" Format=\"XML\">0 0</DataItem>\n"
        "     <DataItem Dimensions=\"2\" Format=\"XML\">{} {}</DataItem>\n"
        "    </Geometry>\n",
        shape_.rows, shape_.columns, shape_.dx, shape_.dx);
  }
  for (const char* name : {"V", "r", "Ta"}) {
    text += fmt::format(
        "    <Attribute Name=\"{}\" AttributeType=\"Scalar\" Center=\"Node\">\n{}    </Attribute>\n", name,
        slab(name, "8", false, frame));
  }
  text += "   </Grid>\n";
  text += tail;
  file_.append_over_tail(text, long(tail.size()));
}

}  // namespace myowave::apps
