#include "rollfix/draw.hpp"

#include <cairo-pdf.h>
#include <cairo.h>
#include <dlfcn.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <random>

#include "draw/save.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

namespace rollfix::draw {
namespace {

[[noreturn]] void fail_to_load() {
  const char* reason = dlerror();
  throw InputError(
      fmt::format("PNG and PDF are drawn by librsvg, which can't be loaded ({}); install it (on Debian: "
                  "librsvg2-2), or give a file name that ends in .svg",
                  reason == nullptr ? "?" : reason));
}

/// A library that is never unloaded: GLib, behind librsvg, does not survive it.
class Library {
 public:
  explicit Library(const char* name) : handle_(dlopen(name, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) fail_to_load();
  }

  /// In the library or in those that it stands on.
  template <class Function>
  void find(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(dlsym(handle_, name));
    if (function == nullptr) fail_to_load();
  }

 private:
  void* handle_;
};

/// What is called of librsvg, cairo and GObject, by the types that their headers declare.
struct Functions {
  explicit Functions(const Library& library) {
    library.find("rsvg_handle_new_from_data", read_svg);
    library.find("rsvg_handle_render_document", draw_svg);
    library.find("g_object_unref", release_object);
    library.find("g_error_free", release_error);
    library.find("cairo_create", create_context);
    library.find("cairo_destroy", release_context);
    library.find("cairo_status", status_of_context);
    library.find("cairo_status_to_string", words_of);
    library.find("cairo_set_source_rgb", set_colour);
    library.find("cairo_paint", paint);
    library.find("cairo_surface_status", status_of_surface);
    library.find("cairo_surface_finish", finish_surface);
    library.find("cairo_surface_destroy", release_surface);
    library.find("cairo_image_surface_create", create_image);
    library.find("cairo_surface_write_to_png_stream", write_png);
    library.find("cairo_pdf_surface_create_for_stream", create_pdf);
    library.find("cairo_pdf_surface_set_metadata", set_pdf_metadata);
  }

  decltype(&rsvg_handle_new_from_data) read_svg;
  decltype(&rsvg_handle_render_document) draw_svg;
  decltype(&g_object_unref) release_object;
  decltype(&g_error_free) release_error;
  decltype(&cairo_create) create_context;
  decltype(&cairo_destroy) release_context;
  decltype(&cairo_status) status_of_context;
  decltype(&cairo_status_to_string) words_of;
  decltype(&cairo_set_source_rgb) set_colour;
  decltype(&cairo_paint) paint;
  decltype(&cairo_surface_status) status_of_surface;
  decltype(&cairo_surface_finish) finish_surface;
  decltype(&cairo_surface_destroy) release_surface;
  decltype(&cairo_image_surface_create) create_image;
  decltype(&cairo_surface_write_to_png_stream) write_png;
  decltype(&cairo_pdf_surface_create_for_stream) create_pdf;
  decltype(&cairo_pdf_surface_set_metadata) set_pdf_metadata;
};

constexpr double kPointsPerPixel = 0.75;  // 72 points and 96 pixels to the inch

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  try {
    static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  } catch (...) {  // no exception may cross cairo's C frames
    return CAIRO_STATUS_NO_MEMORY;
  }
}

class Renderer {
 public:
  explicit Renderer(const char* name) : call_(Library(name)) {}

  std::string png(const std::string& svg, double columns, double rows) const {
    const auto surface =
        owned(call_.create_image(CAIRO_FORMAT_RGB24, static_cast<int>(columns), static_cast<int>(rows)),
              call_.release_surface);
    draw(svg, surface.get(), columns, rows);
    std::string bytes;
    check(call_.write_png(surface.get(), append, &bytes));
    return bytes;
  }

  std::string pdf(const std::string& svg, double across, double down) const {
    std::string bytes;
    const auto surface = owned(call_.create_pdf(append, &bytes, across, down), call_.release_surface);
    check(call_.status_of_surface(surface.get()));
    // The time of writing would make every file differ.
    call_.set_pdf_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
    draw(svg, surface.get(), across, down);
    call_.finish_surface(surface.get());
    check(call_.status_of_surface(surface.get()));
    return bytes;
  }

 private:
  template <class T, class Release>
  static std::unique_ptr<T, Release> owned(T* object, Release release) {
    return {object, release};
  }

  void check(cairo_status_t status) const {
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    if (status != CAIRO_STATUS_SUCCESS) {
      throw InternalError(fmt::format("cairo can't draw the figure: {}", call_.words_of(status)));
    }
  }

  void check(bool success, GError* error) const {
    const auto freed = owned(error, call_.release_error);
    if (!success) throw InternalError(fmt::format("librsvg can't draw the figure: {}", error ? error->message : "?"));
  }

  void draw(const std::string& svg, cairo_surface_t* surface, double width, double height) const {
    check(call_.status_of_surface(surface));
    GError* error = nullptr;
    const auto handle =
        owned(call_.read_svg(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error), call_.release_object);
    check(handle != nullptr, error);
    const auto context = owned(call_.create_context(surface), call_.release_context);
    call_.set_colour(context.get(), 1, 1, 1);
    call_.paint(context.get());
    const RsvgRectangle page{0, 0, width, height};
    error = nullptr;
    check(call_.draw_svg(handle.get(), context.get(), &page, &error) != FALSE, error);
    check(call_.status_of_context(context.get()));
  }

  Functions call_;
};

}  // namespace

std::string render_png(const std::string& svg, double width, double height, double scale, const char* renderer) {
  return Renderer(renderer).png(svg, std::ceil(width * scale), std::ceil(height * scale));
}

std::string render_pdf(const std::string& svg, double width, double height, const char* renderer) {
  return Renderer(renderer).pdf(svg, width * kPointsPerPixel, height * kPointsPerPixel);
}

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
    std::random_device random;  // a name that nobody can foresee, however long the final one is
    temporary_name_ = final_name.parent_path() / fmt::format(".rollfix-{:08x}{:08x}", random(), random());
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

FigureFormat figure_format(const fs::path& file, std::string_view besides) {
  const std::string ending = ending_of(file.string());
  if (ending == ".svg") return FigureFormat::svg;
  if (ending == ".png") return FigureFormat::png;
  if (ending == ".pdf") return FigureFormat::pdf;
  throw InputError(fmt::format("{}: a figure's file name must end in .svg, .png or .pdf{}, found {}", file.string(),
                               besides, ending.empty() ? "no ending" : "\"" + ending + "\""));
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
