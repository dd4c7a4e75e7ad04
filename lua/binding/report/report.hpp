// Figures of a case beside their references: report.json for programs, report.md for people.
#pragma once

#include "lua/binding/schema/value.hpp"

#include <optional>

namespace cdem::script {

inline constexpr int report_schema = 1; // version of report.json, docs/report.schema.json

struct Figure {
  std::string name;
  Value value; // number, text, boolean or nil
  std::string unit;
  Value reference;    // number, text, boolean or nil
  std::string kind;   // formula, paper, fe, trial; "" when there is no reference
  std::string source; // where the reference comes from
  std::optional<double> tolerance;
  bool absolute = false; // tolerance in the figure's unit; else relative to the reference

  // |value - reference| <= tolerance (|reference|); nothing for a trial figure, which is shown beside ours
  // and never judged, nor when a number or the tolerance is missing. Two booleans must be equal.
  std::optional<bool> within() const;
};

struct Report {
  std::string case_name;
  std::vector<Figure> figures; // a figure reported again takes the place of the earlier one

  std::vector<std::string> warnings; // of the run so far
  // Relaxations so far, tables of stage, model, verdict, steps, residual and, where it has one, trial.
  std::vector<Table> relaxations;

  void add(const Figure&);
  std::string json() const;
  std::string markdown() const;
};

// A report.json as a plain value; throws FileError when it cannot be read.
Value read_report(const std::string& json_text, const std::string& shown_name);

} // namespace cdem::script
