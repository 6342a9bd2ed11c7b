#include "render.hpp"

#include <cairo-pdf.h>
#include <cairo.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>

#include <cmath>
#include <memory>

#include "rollfix/error.hpp"

namespace rollfix::draw {
namespace {

struct Release {
  void operator()(RsvgHandle* handle) const { g_object_unref(handle); }
  void operator()(GError* error) const { g_error_free(error); }
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};

template <class T>
using Owned = std::unique_ptr<T, Release>;

constexpr double kPointsPerPixel = 0.75;  // 72 points and 96 pixels to the inch

void check(cairo_status_t status) {
  if (status != CAIRO_STATUS_SUCCESS) {
    throw InternalError(fmt::format("cairo can't draw the figure: {}", cairo_status_to_string(status)));
  }
}

void check(gboolean success, GError* error) {
  const Owned<GError> owned(error);
  if (!success) throw InternalError(fmt::format("librsvg can't draw the figure: {}", owned ? owned->message : "?"));
}

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  try {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {  // no exception may cross cairo's C frames
    return CAIRO_STATUS_NO_MEMORY;
  }
}

void draw(const std::string& svg, cairo_surface_t* surface, double width, double height) {
  check(cairo_surface_status(surface));
  GError* error = nullptr;
  const Owned<RsvgHandle> handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  check(handle != nullptr, error);
  const Owned<cairo_t> context(cairo_create(surface));
  cairo_set_source_rgb(context.get(), 1, 1, 1);
  cairo_paint(context.get());
  const RsvgRectangle page{0, 0, width, height};
  error = nullptr;
  check(rsvg_handle_render_document(handle.get(), context.get(), &page, &error), error);
  check(cairo_status(context.get()));
}

}  // namespace

std::string render_png(const std::string& svg, double width, double height, double scale) {
  const double columns = std::ceil(width * scale), rows = std::ceil(height * scale);
  const Owned<cairo_surface_t> surface(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(columns), static_cast<int>(rows)));
  draw(svg, surface.get(), columns, rows);
  std::string bytes;
  check(cairo_surface_write_to_png_stream(surface.get(), append, &bytes));
  return bytes;
}

std::string render_pdf(const std::string& svg, double width, double height) {
  std::string bytes;
  const double across = width * kPointsPerPixel, down = height * kPointsPerPixel;
  const Owned<cairo_surface_t> surface(cairo_pdf_surface_create_for_stream(append, &bytes, across, down));
  check(cairo_surface_status(surface.get()));
  // The time of writing would make every file differ.
  cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
  draw(svg, surface.get(), across, down);
  cairo_surface_finish(surface.get());
  check(cairo_surface_status(surface.get()));
  return bytes;
}

}  // namespace rollfix::draw
