#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "rollfix/error.hpp"
#include "rollfix/identify.hpp"
#include "text/number.hpp"
#include "text/text.hpp"

namespace rollfix {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 6> kEndings = {".csv", ".dat", ".txt", ".dxf", ".svg", ".json"};

bool has_known_ending(const fs::path& file) {
  const std::string ending = ending_of(file.string());
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

bool is_gallery(const std::string& argument) { return argument.rfind("gallery:", 0) == 0; }

std::vector<CatalogSource> sources_in(const std::string& folder) {
  std::vector<CatalogSource> sources;
  std::error_code error;
  for (fs::recursive_directory_iterator file(folder, fs::directory_options::follow_directory_symlink, error), end;
       file != end; file.increment(error)) {
    if (!file->is_regular_file() || !has_known_ending(file->path())) continue;
    sources.push_back({file->path().string(), file->path().lexically_relative(folder).string()});
  }
  if (error) throw InputError(fmt::format("{}: can't be read: {}", folder, error.message()));
  if (sources.empty()) {
    throw InputError(
        fmt::format("{}: expected outlines in this folder ({}), found none", folder, fmt::join(kEndings, ", ")));
  }
  std::sort(sources.begin(), sources.end(),
            [](const CatalogSource& a, const CatalogSource& b) { return a.name < b.name; });
  return sources;
}

/// A list names files and gallery shapes; an outline has numbers.
bool is_list(const std::string& path, std::string_view text) {
  const std::string ending = ending_of(path);
  if (ending == ".dxf" || ending == ".svg" || ending == ".json" || ending == ".dat") return false;
  for (const std::string_view line : split(text, '\n')) {
    if (line.empty() || line.front() == '#') continue;
    const std::string first(split(line, '\t')[0]);
    return is_gallery(first) || fs::exists(fs::path(path).parent_path() / first);
  }
  return false;
}

std::vector<CatalogSource> sources_listed(const std::string& path, std::string_view text) {
  std::vector<CatalogSource> sources;
  std::size_t number = 0;
  for (const std::string_view line : split(text, '\n')) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> fields = split(line, '\t');
    CatalogSource source;
    source.name = fields[0];
    source.argument = is_gallery(source.name) ? source.name : (fs::path(path).parent_path() / source.name).string();
    if (fields.size() > 1) {
      const std::optional<double> count = parse_number(fields[1]);
      if (!count || !(*count > 0)) {
        throw InputError(fmt::format("{}:{}: count '{}': expected a number above 0", path, number, fields[1]));
      }
      source.count = *count;
    }
    sources.push_back(std::move(source));
  }
  return sources;
}

}  // namespace

std::vector<CatalogSource> catalog_sources(const std::string& argument) {
  if (is_gallery(argument)) return {{argument, argument}};
  if (fs::is_directory(argument)) return sources_in(argument);
  const std::string text = read_text(argument);
  if (is_list(argument, without_mark(text))) return sources_listed(argument, without_mark(text));
  return {{argument, fs::path(argument).filename().string()}};
}

}  // namespace rollfix
