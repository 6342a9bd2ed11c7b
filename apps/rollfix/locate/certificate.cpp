#include "rollfix/locate/certificate.hpp"

#include <fmt/format.h>

#include <utility>

#include "rollfix/certify.hpp"
#include "rollfix/documents.hpp"
#include "rollfix/error.hpp"
#include "rollfix/output/files.hpp"

namespace rollfix::app {
namespace {

/// A certificate is of readings that are exact but for the tolerance.
void require_plain(const Problem& problem) {
  const auto refuse = [](bool found, const char* what) {
    if (!found) return;
    throw InputError(fmt::format("--certify: a certificate is of one way round without noise, found {}", what));
  };
  refuse(problem.noise.has_value(), "--noise");
  refuse(problem.either_way, "--direction either");
  refuse(problem.mirrored, "--mirror");
}

/// A certificate as text, and whether it proves everything.
struct Written {
  std::string text;
  bool is_complete = true;
  const char* where = "its cells say where";
};

Written written(const Problem& problem, const Answer& answer) {
  LocateOptions options;
  options.tolerance = answer.tolerance.value;
  options.facing = answer.facing;
  if (problem.budget) options.budget = *problem.budget;
  if (answer.finger_count() == 2) {
    const PairCertificate certificate = certify_pair(answer.part, answer.readings, options);
    return {format_certificate(certificate), certificate.is_complete()};
  }
  const Certificate certificate = certify(answer.part, answer.readings, options);
  return {format_certificate(certificate), certificate.is_complete()};
}

void add_written(const std::string& file, bool force, Written certificate, Report& report) {
  if (file == "-") {
    report.notes.push_back(report.data.substr(0, report.data.find('\n')));
    report.data = std::move(certificate.text);
  } else {
    report.files.push_back({file, std::move(certificate.text), force});
    report.notes.push_back(fmt::format("wrote {}", file));
  }
  if (certificate.is_complete) return;
  report.notes.push_back(fmt::format("the certificate leaves something unproved: {}", certificate.where));
  report.exit_code = ExitCode::incomplete;
}

}  // namespace

void require_certificate(const std::string& file, bool force, bool json, const std::string& output) {
  if (file.empty()) return;
  if (file != "-") {
    require_writable(file, force);
  } else if (json || output == "-") {
    throw InputError("--certify - writes to standard output, as another option does: give it the name of a file");
  }
}

void add_certificate(const std::string& file, bool force, const Problem& problem, const Answer& answer,
                     Report& report) {
  require_plain(problem);
  add_written(file, force, written(problem, answer), report);
}

void add_certificate(const std::string& file, bool force, const TouchProblem& problem, const TouchAnswer& answer,
                     Report& report) {
  const TouchCertificate certificate = certify_touches(answer, problem.budget);
  add_written(file, force, {format_certificate(certificate), certificate.is_complete(), "`unresolved` says where"},
              report);
}

void add_certificate(const std::string& file, bool force, const HoldProblem& problem, const HoldAnswer& answer,
                     Report& report) {
  const HoldCertificate certificate = certify_holds(problem, answer);
  const char* where = certificate.unresolved.empty() ? "sets without `first` say where" : "`unresolved` says where";
  add_written(file, force, {format_certificate(certificate), certificate.is_complete(), where}, report);
}

}  // namespace rollfix::app
