#pragma once

#include <string>

namespace rollfix::draw {

/// An SVG document drawn by librsvg and cairo. `width`, `height`: of the page, pixels of the document.
/// Throw InternalError: the document can't be read, or cairo failed.
std::string render_png(const std::string& svg, double width, double height, double scale);
std::string render_pdf(const std::string& svg, double width, double height);

}  // namespace rollfix::draw
