#include "documents/documents.hpp"

namespace rollfix {

const char* name_of(Closing closing) {
  switch (closing) {
    case Closing::spread:
      return "spread";
    case Closing::bridged:
      return "bridged";
    case Closing::kept_open:
      return "kept_open";
    case Closing::not_asked:
      break;
  }
  return "open";
}

Json taught_json(const Taught& taught) {
  return {{"closing", name_of(taught.closing)},
          {"rolled", taught.rolled},
          {"lap", taught.lap},
          {"overlap", taught.overlap},
          {"turns", taught.turns},
          {"turn_gap", taught.turn_gap},
          {"turn_allowed", taught.turn_allowed},
          {"gap", taught.gap},
          {"gap_allowed", taught.gap_allowed},
          {"bridge", taught.bridge},
          {"correction", taught.correction},
          {"deviation", taught.deviation},
          {"row_sd", taught.row_sd}};
}

}  // namespace rollfix
