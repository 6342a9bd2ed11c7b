#include "files/dxf/dxf.hpp"

#include <memory>

#include "files/dxf/expand.hpp"
#include "files/dxf/model.hpp"
#include "files/dxf/read.hpp"
#include "files/dxf/tags.hpp"
#include "files/dxf/units.hpp"

namespace rollfix {

Drawing parse_dxf(std::string_view bytes, const std::string& name, const DxfOptions& options) {
  const std::unique_ptr<dxf::TagReader> reader = dxf::open_tags(bytes, name);
  const dxf::Model model = dxf::read_model(*reader);
  Drawing drawing;
  drawing.name = name;
  dxf::set_unit(model, drawing);
  dxf::expand(model, *reader, options.layer, drawing);
  return drawing;
}

}  // namespace rollfix
