#pragma once

#include <string>

namespace rollfix::draw {

/// The library that draws PNG and PDF. It brings some forty others, so that loading it takes longer than an answer: it
/// is loaded when the first such figure is asked for, and then stays.
inline constexpr const char* kRenderer = "librsvg-2.so.2";

/// An SVG document drawn by librsvg and cairo. `width`, `height`: of the page, pixels of the document.
/// Throw InputError: `renderer` is not installed; InternalError: the document can't be read, or cairo failed.
std::string render_png(const std::string& svg, double width, double height, double scale,
                       const char* renderer = kRenderer);
std::string render_pdf(const std::string& svg, double width, double height, const char* renderer = kRenderer);

}  // namespace rollfix::draw
