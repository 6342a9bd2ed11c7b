#include "documents.hpp"
#include "rollfix/files/documents.hpp"

namespace rollfix {
namespace {

Json place_json(const CurvePlace& place) { return Json::array({place.curve, json_number(place.u)}); }

Json curves_json(const std::vector<CurveRecord>& curves) {
  Json list = Json::array();
  for (const CurveRecord& curve : curves) {
    list.push_back({{"kind", curve.kind}, {"numbers", json_numbers(curve.numbers)}});
  }
  return list;
}

/// An open outline's last row ends the last cell.
Json rows_json(const Certificate& certificate) {
  Json list = Json::array();
  for (const CertificateRow& row : certificate.rows) {
    list.push_back({{"start", place_json(row.start)}, {"end", place_json(row.end)}, {"off", json_number(row.off)}});
    if (certificate.closed || list.size() < certificate.rows.size()) list.back()["then"] = name_of(row.then);
  }
  return list;
}

/// At a corner the finger pivots, which leaves the tangent open.
Json placements_json(const Certificate& certificate) {
  Json list = Json::array();
  for (const CertifiedPlacement& one : certificate.placements) {
    const Placement& placement = one.placement;
    list.push_back({{"kind", name_of(placement.kind)},
                    {"start", json_number(placement.start[0])},
                    {"end", json_number(placement.end[0])},
                    {"at", place_json(one.at)},
                    {"point", point_json(placement.point[0])}});
    if (placement.kind != Kind::corner) list.back()["tangent"] = json_number(placement.tangent[0]);
  }
  return list;
}

}  // namespace

std::string format_certificate(const Certificate& certificate) {
  return json_text(
      {{"schema", "rollfix/certificate/1"},
       {"part", certificate.part},
       {"closed", certificate.closed},
       {"perimeter", json_number(certificate.perimeter)},
       {"origin", point_json(certificate.origin)},
       {"gap", json_number(certificate.gap)},
       {"curves", curves_json(certificate.curves)},
       {"reading",
        {{"length", json_number(certificate.reading.length[0])}, {"turn", json_number(certificate.reading.turn)}}},
       {"tolerance", json_number(certificate.tolerance)},
       {"rows", rows_json(certificate)},
       {"placements", placements_json(certificate)}});
}

}  // namespace rollfix
