#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rollfix/draw/svg.hpp"

namespace rollfix {

enum class FigureFormat { svg, png, pdf };

/// The format that a file name's ending asks for, upper case or lower.
/// Throws InputError listing the known endings.
FigureFormat figure_format(const std::filesystem::path& file);

/// The figure as the bytes of a file. PNG: white background, two pixels for each of the figure's.
/// The same figure gives the same bytes on the same machine (PNG and PDF depend on its fonts).
/// Throws InternalError: the renderer failed.
std::string encode(const Svg& figure, FigureFormat format);

/// Writes the figure in the format that the file's ending asks for. It is written beside the file under a
/// temporary name and then renamed: an older file is replaced whole or not at all.
/// Throws InputError: unknown ending, or a place that can't be written to.
void save_figure(const Svg& figure, const std::filesystem::path& file);

}  // namespace rollfix
