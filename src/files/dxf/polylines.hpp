#pragma once

#include "files/dxf/entity_tags.hpp"

namespace rollfix::dxf {

/// LWPOLYLINE. Throws InputError.
Shape read_light_polyline(EntityTags& tags);

/// POLYLINE with its VERTEX records up to SEQEND; a mesh is an OtherShape. Throws InputError.
Shape read_polyline(EntityTags& tags);

}  // namespace rollfix::dxf
