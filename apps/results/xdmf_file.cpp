#include "apps/results/xdmf_file.hpp"

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

// A flat sheet of a regular grid is one layer of a 3-D one: viewers turn a 2-D one into the X2-X3 plane.
XdmfFile::XdmfFile(const FrameShape& shape, std::string fields_name, AppendedFile file)
    : shape_(shape),
      fields_name_(std::move(fields_name)),
      grid_size_(fmt::format("{}{} {}", shape.deforms() ? "" : "1 ", shape.rows, shape.columns)),
      file_(std::move(file)) {}

XdmfFile::XdmfFile(const std::filesystem::path& path, const FrameShape& shape, std::string fields_name)
    : XdmfFile(shape, std::move(fields_name), AppendedFile(path, fmt::format("{}{}", head, tail))) {}

XdmfFile::XdmfFile(const std::filesystem::path& path, const FrameShape& shape, std::string fields_name,
                   std::uintmax_t size)
    : XdmfFile(shape, std::move(fields_name), AppendedFile(path, size)) {}

// One frame of a dataset. The dataset grows; its size is given as it is with this frame.
std::string XdmfFile::slab(std::string_view dataset, int precision, bool vector, std::size_t frame) const {
  const auto shape = fmt::format("{} {}{}", shape_.rows, shape_.columns, vector ? " 2" : "");
  const std::string_view zeros = vector ? "0 0 0" : "0 0";
  const std::string_view ones = vector ? "1 1 1" : "1 1";
  return fmt::format(
      R"(     <DataItem ItemType="HyperSlab" Dimensions="{}{}" Type="HyperSlab">
      <DataItem Dimensions="3 {}" Format="XML">{} {} 1 {} 1 {}</DataItem>
      <DataItem Dimensions="{} {}" NumberType="Float" Precision="{}" Format="HDF">{}:/{}</DataItem>
     </DataItem>
)",
      grid_size_, vector ? " 2" : "", vector ? 4 : 3, frame, zeros, ones, shape, frame + 1, shape, precision,
      fields_name_, dataset);
}

void XdmfFile::append(std::size_t frame, double t) {
  std::string text = fmt::format(R"(   <Grid Name="frame {}" GridType="Uniform">
    <Time Value="{}"/>
)",
                                 frame, t);
  if (shape_.deforms()) {
    text += fmt::format(R"(    <Topology TopologyType="2DSMesh" Dimensions="{}"/>
    <Geometry GeometryType="XY">
{}    </Geometry>
)",
                        grid_size_, slab("grid", 4, true, frame));
  } else {
    text += fmt::format(R"(    <Topology TopologyType="3DCoRectMesh" Dimensions="{0}"/>
    <Geometry GeometryType="ORIGIN_DXDYDZ">
     <DataItem Dimensions="3" NumberType="Float" Precision="8" Format="XML">0 0 0</DataItem>
     <DataItem Dimensions="3" NumberType="Float" Precision="8" Format="XML">{1} {1} {1}</DataItem>
    </Geometry>
)",
                        grid_size_, shape_.dx);
  }
  for (const std::string_view name : {"V", "r", "Ta"}) {
    if (name == "Ta" && !shape_.tension) continue;
    text += fmt::format(R"(    <Attribute Name="{}" AttributeType="Scalar" Center="Node">
{}    </Attribute>
)",
                        name, slab(name, 8, false, frame));
  }
  text += "   </Grid>\n";
  text += tail;
  file_.append_over_tail(text, long(tail.size()));
}

}  // namespace myowave::apps
