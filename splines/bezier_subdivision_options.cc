#include <cmath>

#include "splines/bezier_subdivision.h"

namespace batten {
namespace {

constexpr int kDeepest = 50;
constexpr int kMostPieces = 1 << 24;

bool FailRange(const std::string& field, double value, const std::string& range,
               std::string* error) {
  if (error != nullptr) *error = field + " is " + std::to_string(value) + ", must be " + range;
  return false;
}

}  // namespace

const char* ToString(SubdivisionMode mode) {
  return mode == SubdivisionMode::kAdaptive ? "adaptive" : "uniform";
}

bool FromString(const std::string& text, SubdivisionMode* mode) {
  if (text != "adaptive" && text != "uniform") return false;
  *mode = text == "adaptive" ? SubdivisionMode::kAdaptive : SubdivisionMode::kUniform;
  return true;
}

const char* ToString(SubdivisionEnd end) {
  switch (end) {
    case SubdivisionEnd::kAllPass:
      return "all_pass";
    case SubdivisionEnd::kDepthLimit:
      return "depth_limit";
    case SubdivisionEnd::kPieceLimit:
      return "piece_limit";
    case SubdivisionEnd::kNotRun:
      break;
  }
  return "not_run";
}

bool SubdivisionOptions::IsValid(std::string* error) const {
  const bool is_angle = stop == StopMeasure::kAngle;
  if (!(relative_tolerance >= 0.0 && std::isfinite(relative_tolerance)) ||
      (is_angle && relative_tolerance >= M_PI_2)) {
    return FailRange("relative_tolerance", relative_tolerance,
                     is_angle ? "in [0, pi / 2)" : ">= 0 and finite", error);
  }
  if (!(reference_size >= 0.0 && std::isfinite(reference_size))) {
    return FailRange("reference_size", reference_size, ">= 0 and finite", error);
  }
  if (max_depth < 1 || max_depth > kDeepest) {
    return FailRange("max_depth", max_depth, "in [1, 50]", error);
  }
  if (max_pieces < 1 || max_pieces > kMostPieces) {
    return FailRange("max_pieces", max_pieces, "in [1, 16777216]", error);
  }
  return true;
}

}  // namespace batten
