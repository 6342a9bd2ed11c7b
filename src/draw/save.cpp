#include "rollfix/draw/svg.hpp"

#include <cairo-pdf.h>
#include <cairo.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "rollfix/error.hpp"
#include "text/text.hpp"

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

/// An SVG document drawn by librsvg and cairo. `width`, `height`: of the page, pixels of the document.
/// Throw InternalError: the document can't be read, or cairo failed.
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

}  // namespace
}  // namespace rollfix::draw

namespace rollfix {
namespace {

namespace fs = std::filesystem;

constexpr double kPngScale = 2;  // pixels of the image for each of the figure's

[[noreturn]] void fail(const fs::path& file, int error) {
  throw InputError(fmt::format("can't write {}: {}; give a file in a folder that exists and that you may write to",
                               file.string(), std::strerror(error)));
}

/// A new file that removes itself unless it is moved to its final name.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& final_name) : final_name_(final_name) {
    static std::atomic<unsigned> counter{0};
    temporary_name_ = final_name;
    temporary_name_.replace_filename(fmt::format(".{}.{}.{}", final_name.filename().string(), getpid(), counter++));
    file_ = std::fopen(temporary_name_.c_str(), "wbx");
    if (file_ == nullptr) fail(final_name_, errno);
  }
  ~TemporaryFile() {
    if (file_ != nullptr) std::fclose(file_);
    if (!moved_) std::remove(temporary_name_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(const std::string& bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail(final_name_, errno);
  }

  void move_to_final_name() {
    const bool closed = std::fclose(file_) == 0;
    file_ = nullptr;
    if (!closed || std::rename(temporary_name_.c_str(), final_name_.c_str()) != 0) fail(final_name_, errno);
    moved_ = true;
  }

 private:
  fs::path final_name_;
  fs::path temporary_name_;
  std::FILE* file_ = nullptr;
  bool moved_ = false;
};

/// Where a link points to, so that the link itself stays.
fs::path followed(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_symlink(file, ignored)) return file;
  const fs::path target = fs::weakly_canonical(file, ignored);
  return ignored ? file : target;
}

}  // namespace

FigureFormat figure_format(const fs::path& file) {
  const std::string ending = ending_of(file.string());
  if (ending == ".svg") return FigureFormat::svg;
  if (ending == ".png") return FigureFormat::png;
  if (ending == ".pdf") return FigureFormat::pdf;
  throw InputError(fmt::format("{}: a figure's file name must end in .svg, .png or .pdf, found {}", file.string(),
                               ending.empty() ? "no ending" : "\"" + ending + "\""));
}

std::string encode(const Svg& figure, FigureFormat format) {
  switch (format) {
    case FigureFormat::png:
      return draw::render_png(figure.str(), figure.width(), figure.height(), kPngScale);
    case FigureFormat::pdf:
      return draw::render_pdf(figure.str(), figure.width(), figure.height());
    case FigureFormat::svg:
      break;
  }
  return figure.str();
}

void save_figure(const Svg& figure, const fs::path& file) {
  const std::string bytes = encode(figure, figure_format(file));
  const fs::path target = followed(file);
  std::error_code ignored;
  if (fs::is_directory(target, ignored)) fail(file, EISDIR);
  TemporaryFile temporary(target);
  temporary.write(bytes);
  temporary.move_to_final_name();
}

}  // namespace rollfix
