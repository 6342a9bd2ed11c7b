#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "rollfix/identify.hpp"

// What studies of how long it takes to tell parts apart have in common.

inline rollfix::Catalog splines(const std::string& file) {
  std::vector<rollfix::CatalogSource> sources;
  for (int k = 1; k <= 200; ++k) {
    const std::string shape = fmt::format("gallery:spline,n=9,wobble=0.2,seed={}", k);
    sources.push_back({shape, shape});
  }
  std::filesystem::remove(file);
  rollfix::build_catalog(file, sources);
  return rollfix::Catalog(file);
}

inline double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Seen {
  std::vector<double> milliseconds;
  double searched = 0;
  double listed = 0;
  std::size_t found = 0;  // the true part among them
};
