#include "rollfix/draw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>

#include "draw/render.hpp"
#include "rollfix/error.hpp"
#include "text/text.hpp"

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
