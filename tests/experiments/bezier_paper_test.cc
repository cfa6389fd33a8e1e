// The rules of the reproduction `bezier-subdivision`, on tables made by hand: each verdict is seen.
#include "experiments/bezier_paper.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/bezier_paper_curves.h"
#include "experiments/bezier_paper_runs.h"

namespace batten {
namespace {

std::string VerdictWord(const Experiment& experiment, std::size_t claim,
                        const ExperimentTables& tables) {
  return ToString(experiment.claims.at(claim).judge(tables).verdict);
}

/// Uniform rounds: savings of a rule at five degrees.
ExperimentTables TableOf(const std::string& rule, const std::vector<std::string>& savings) {
  ExperimentTables tables;
  CsvTable& table = tables[""] =
      CsvTable({"degree", "setting", "rule", "rounds", "published_rounds", "saving"});
  for (std::size_t k = 0; k < savings.size(); ++k) {
    const std::string degree = std::to_string(12 + k);
    table.AddRow({degree, "uniform", "half", "11", "11", "0"});
    table.AddRow({degree, "uniform", rule, "10", "10", savings[k]});
  }
  return tables;
}

TEST(BezierPaperTable, FlatnessIsJudgedByHowOftenItSavesHalf) {
  const Experiment table = BezierPaperTable();
  EXPECT_EQ(VerdictWord(table, 0, TableOf("flatness", {"0.6", "0.7", "0.65", "0.5", "-0.05"})),
            "holds");
  EXPECT_EQ(VerdictWord(table, 0, TableOf("flatness", {"0.6", "0.7", "0.65", "0.5", "-0.6"})),
            "holds in part");
  EXPECT_EQ(VerdictWord(table, 0, TableOf("flatness", {"0.6", "0", "0", "0", "0"})),
            "holds in part");
  EXPECT_EQ(VerdictWord(table, 0, TableOf("flatness", {"0.4", "0", "0", "0", "0"})),
            "does not hold");
  EXPECT_EQ(VerdictWord(table, 0, TableOf("flatness", {})), "undecided");
}

TEST(BezierPaperTable, HullHoldsWhereItSavesNothing) {
  const Experiment table = BezierPaperTable();
  EXPECT_EQ(VerdictWord(table, 1, TableOf("hull", {"0.04", "-3", "0", "0", "0"})), "holds");
  EXPECT_EQ(VerdictWord(table, 1, TableOf("hull", {"0.2", "0.2", "0", "0", "0"})), "holds in part");
  EXPECT_EQ(VerdictWord(table, 1, TableOf("hull", {"0.2", "0.2", "0.2", "0", "0"})),
            "does not hold");
  EXPECT_EQ(VerdictWord(table, 1, TableOf("hull", {})), "undecided");
}

struct CellOf {
  std::string degree;
  std::string pieces;
  std::string seconds;
  std::string error = "0.9";
};

ExperimentTables CellsOf(const std::string& mode, const std::string& rule,
                         const std::vector<CellOf>& cells) {
  ExperimentTables tables;
  CsvTable& table = tables[""] = CsvTable({"family", "degree", "setting", "rule", "pieces_ratio",
                                           "seconds_ratio", "error_over_tolerance"});
  for (const CellOf& cell : cells) {
    table.AddRow({"walk", cell.degree, mode, rule, cell.pieces, cell.seconds, cell.error});
  }
  return tables;
}

TEST(BezierPaperFamilies, HalfTheTimeIsAskedOfEveryCellFromDegree12) {
  const Experiment families = BezierPaperFamilies();
  const auto verdict = [&](const std::vector<CellOf>& cells) {
    return VerdictWord(families, 0, CellsOf("uniform", "flatness", cells));
  };
  EXPECT_EQ(verdict({{"3", "2", "2"}, {"12", "0.5", "0.4"}, {"25", "0.5", "0.5"}}), "holds");
  EXPECT_EQ(verdict({{"12", "0.5", "0.4"}, {"25", "1", "1"}}), "holds in part");
  EXPECT_EQ(verdict({{"12", "2", "2"}, {"25", "1", "1"}}), "does not hold");
  EXPECT_EQ(verdict({}), "undecided");
}

TEST(BezierPaperFamilies, HullSavesNothingWhereNoCellIsFaster) {
  const Experiment families = BezierPaperFamilies();
  const auto verdict = [&](const std::vector<CellOf>& cells) {
    return VerdictWord(families, 1, CellsOf("uniform", "hull", cells));
  };
  EXPECT_EQ(verdict({{"12", "1", "1.2"}, {"25", "1", "2"}}), "holds");
  EXPECT_EQ(verdict({{"12", "1", "0.9"}, {"25", "1", "2"}}), "holds in part");
  EXPECT_EQ(verdict({{"12", "1", "0.9"}, {"25", "1", "0.5"}}), "does not hold");
}

TEST(BezierPaperFamilies, AdaptivePiecesAreComparedToTenPercentEitherWay) {
  const Experiment families = BezierPaperFamilies();
  const auto verdict = [&](const std::vector<CellOf>& cells) {
    return VerdictWord(families, 2, CellsOf("adaptive", "flatness", cells));
  };
  EXPECT_EQ(verdict({{"12", "1.05", "1"}, {"25", "0.95", "1"}}), "holds");
  EXPECT_EQ(verdict({{"12", "1.2", "1"}, {"25", "0.95", "1"}}), "holds in part");
  EXPECT_EQ(verdict({{"12", "1.2", "1"}, {"25", "0.8", "1"}}), "does not hold");
}

TEST(BezierPaperFamilies, LongestNeedsPiecesTimeAndTheCertificate) {
  const Experiment families = BezierPaperFamilies();
  const auto verdict = [&](const std::vector<CellOf>& cells) {
    return VerdictWord(families, 4, CellsOf("certified", "longest", cells));
  };
  EXPECT_EQ(verdict({{"3", "0.72", "1.5"}, {"12", "0.7", "1.1"}, {"25", "0.71", "0.9"}}), "holds");
  EXPECT_EQ(verdict({{"3", "0.72", "1.5"}, {"12", "0.7", "1.3"}, {"25", "0.71", "0.9"}}),
            "holds in part");
  EXPECT_EQ(verdict({{"12", "0.8", "1"}}), "does not hold");
  EXPECT_EQ(verdict({{"12", "0.7", "1", "1.01"}}), "does not hold");
  EXPECT_EQ(verdict({}), "undecided");
}

TEST(BezierPaperFamilies, ThePapersStopIsJudgedByCertifiedErrors) {
  const Experiment families = BezierPaperFamilies();
  const auto verdict = [&](const std::vector<CellOf>& cells) {
    return VerdictWord(families, 3, CellsOf("adaptive", "half", cells));
  };
  EXPECT_EQ(verdict({{"3", "1", "1", "1"}, {"12", "1", "1", "0.9"}}), "holds");
  EXPECT_EQ(verdict({{"3", "1", "1", "1"}, {"12", "1", "1", "1.1"}}), "holds in part");
  EXPECT_EQ(verdict({{"12", "1", "1", "1.1"}}), "does not hold");
}

TEST(BezierPaperRounds, AskForALeastTimeInside) {
  const Experiment rounds = BezierPaperRounds();
  const auto verdict = [&](const std::vector<std::string>& ratios) {
    ExperimentTables tables;
    CsvTable& table = tables[""] = CsvTable({"family", "rule", "N", "seconds_ratio"});
    for (std::size_t n = 0; n < ratios.size(); ++n) {
      table.AddRow({"walk", "flatness", std::to_string(n), ratios[n]});
    }
    return VerdictWord(rounds, 0, tables);
  };
  EXPECT_EQ(verdict({"1", "0.8", "0.7", "0.6", "0.7", "0.8", "0.9", "1", "1.1"}), "holds");
  EXPECT_EQ(verdict({"1", "1.8", "1.7", "1.6", "1.7", "1.8", "1.9", "2", "2.1"}), "does not hold");
  EXPECT_EQ(verdict({"1", "0.9", "0.8", "0.7", "0.6", "0.5", "0.4", "0.3", "0.2"}),
            "does not hold");
  EXPECT_EQ(verdict({"1", "0.9"}), "undecided");
}

TEST(BezierPaperBestCuts, CountSharesByMeasureAndFamily) {
  const Experiment best_cuts = BezierPaperBestCuts();
  // Of 100 cuts in rounds 0 and 3: so many at 0.525, the others at `elsewhere`.
  const auto verdict = [&](std::size_t claim, int near_half, const std::string& elsewhere) {
    ExperimentTables tables;
    CsvTable& table = tables[""] = CsvTable({"measure", "family", "round", "u", "cuts"});
    for (const char* round : {"0", "3"}) {
      table.AddRow({"flatness", "walk", round, "0.525", std::to_string(near_half)});
      table.AddRow({"flatness", "walk", round, elsewhere, std::to_string(100 - near_half)});
    }
    return VerdictWord(best_cuts, claim, tables);
  };
  EXPECT_EQ(verdict(0, 95, "0.9"), "holds");
  EXPECT_EQ(verdict(0, 94, "0.9"), "does not hold");
  EXPECT_EQ(verdict(1, 90, "0.7"), "holds");
  EXPECT_EQ(verdict(1, 89, "0.7"), "does not hold");
  EXPECT_EQ(verdict(1, 50, "0.425"), "holds");
}

TEST(BezierPaperAffine, OneChangedCountIsEnough) {
  const Experiment affine = BezierPaperAffine();
  const auto verdict = [&](const std::string& turned, const std::string& scaled) {
    ExperimentTables tables;
    CsvTable& table = tables[""] =
        CsvTable({"map", "pieces", "pieces_before", "rounds", "rounds_before"});
    table.AddRow({"rotation", turned, "100", "9", "9"});
    table.AddRow({"scaling", scaled, "100", "9", "9"});
    return VerdictWord(affine, 0, tables);
  };
  EXPECT_EQ(verdict("100", "100"), "holds");
  EXPECT_EQ(verdict("101", "100"), "holds in part");
  EXPECT_EQ(verdict("101", "99"), "does not hold");
}

TEST(BezierPaperOneCut, ComparesWithTheMiddle) {
  const Experiment figure = BezierPaperOneCut();
  const auto verdict = [&](const std::string& flatness, const std::string& hull) {
    ExperimentTables tables;
    CsvTable& table = tables[""] = CsvTable({"rule", "u", "flatness", "hull_area"});
    table.AddRow({"half", "0.5", "2", "2"});
    table.AddRow({"hull", "0.4", "2", hull});
    table.AddRow({"flatness", "0.6", flatness, "2"});
    return VerdictWord(figure, 0, tables);
  };
  EXPECT_EQ(verdict("1.9", "1.9"), "holds");
  EXPECT_EQ(verdict("1.9", "2"), "holds in part");
  EXPECT_EQ(verdict("2", "2"), "does not hold");
}

TEST(BezierPaperMinima, TheGridIsJudgedByWhatItMisses) {
  const Experiment minima = BezierPaperMinima();
  const auto verdict = [&](const std::string& flatness, const std::string& hull) {
    ExperimentTables tables;
    CsvTable& table = tables[""] = CsvTable({"measure", "method", "value_over_least"});
    table.AddRow({"flatness", "grid", flatness});
    table.AddRow({"hull_area", "grid", hull});
    return VerdictWord(minima, 0, tables);
  };
  EXPECT_EQ(verdict("1.1", "1"), "holds");
  EXPECT_EQ(verdict("1.2", "1"), "holds in part");
  EXPECT_EQ(verdict("1.2", "1.2"), "does not hold");
}

TEST(BezierPaperEqualError, AsksForAQuarterInEveryCell) {
  const Experiment equal_error = BezierPaperEqualError();
  const auto verdict = [&](const std::vector<std::string>& ratios) {
    ExperimentTables tables;
    CsvTable& table = tables[""] = CsvTable({"rule", "pieces_ratio"});
    table.AddRow({"half", "1"});
    for (const std::string& ratio : ratios) table.AddRow({"longest", ratio});
    return VerdictWord(equal_error, 0, tables);
  };
  EXPECT_EQ(verdict({"0.75", "0.7"}), "holds");
  EXPECT_EQ(verdict({"0.76", "0.7"}), "holds in part");
  EXPECT_EQ(verdict({"0.76", "0.8"}), "does not hold");
  EXPECT_EQ(verdict({}), "undecided");
}

TEST(BezierPaperMinima, ExactMustFindTheLeastOnEveryCurve) {
  const Experiment minima = BezierPaperMinima();
  const auto verdict = [&](const std::string& found, const std::string& ratio) {
    ExperimentTables tables;
    CsvTable& table = tables[""] = CsvTable({"measure", "method", "found", "value_over_least"});
    table.AddRow({"flatness", "exact", "least", "1"});
    table.AddRow({"flatness", "exact", found, ratio});
    return VerdictWord(minima, 1, tables);
  };
  EXPECT_EQ(verdict("least", "1.0000001"), "holds");
  EXPECT_EQ(verdict("none", "1.0000001"), "holds in part");
  EXPECT_EQ(verdict("least", "1.1"), "holds in part");
  EXPECT_EQ(verdict("other", "1.1"), "does not hold");
}

TEST(BezierPaperMinima, DescentIsJudgedByWhereItEnds) {
  const Experiment minima = BezierPaperMinima();
  const auto verdict = [&](const std::string& found) {
    ExperimentTables tables;
    CsvTable& table = tables[""] = CsvTable({"measure", "method", "found"});
    table.AddRow({"flatness", "lbfgs", "least"});
    table.AddRow({"flatness", "ceres_lm", found});
    return VerdictWord(minima, 2, tables);
  };
  EXPECT_EQ(verdict("least"), "holds");
  EXPECT_EQ(verdict("other"), "holds in part");
  EXPECT_EQ(verdict("none"), "does not hold");
}

TEST(BezierPaperBestCuts, DrawBothMeasures) {
  const Experiment best_cuts = BezierPaperBestCuts();
  ExperimentTables tables;
  CsvTable& table = tables[""] = CsvTable({"measure", "family", "round", "u", "cuts"});
  table.AddRow({"flatness", "walk", "0", "0.525", "3"});
  table.AddRow({"hull_area", "walk", "0", "0.475", "3"});
  ASSERT_EQ(best_cuts.figures.size(), 2);
  const std::vector<PlotPanel> hull = best_cuts.figures[1].panels(tables);
  ASSERT_EQ(hull.size(), 1);
  EXPECT_EQ(hull[0].series.at(0).x, std::vector<double>{0.475});
}

TEST(BezierPaperCurves, AreTheSameOnAnyMachine) {
  const Points walk = FamilyCurve("walk", 12, 0).control_points();
  EXPECT_EQ(walk.rows(), 13);
  const Points again = FamilyCurve("walk", 12, 0).control_points();
  EXPECT_EQ(walk, again);
  EXPECT_NE(walk, FamilyCurve("walk", 12, 1).control_points());
  EXPECT_LT((walk.bottomRows(12) - walk.topRows(12)).cwiseAbs().maxCoeff(), 1.0 + 1e-15);
  EXPECT_LE(FamilyCurve("uniform", 25, 3).control_points().cwiseAbs().maxCoeff(), 1.0);
}

TEST(BezierPaperCurves, GlyphsAreQuadraticsAndCubics) {
  std::vector<BezierCurve> curves;
  std::string error;
  ASSERT_TRUE(GlyphCurves("noto_mono", &curves, &error)) << error;
  EXPECT_EQ(curves.size(), 155);
  for (const BezierCurve& curve : curves) EXPECT_EQ(curve.degree(), 2);
  curves.clear();
  ASSERT_TRUE(GlyphCurves("ebgaramond_italic", &curves, &error)) << error;
  EXPECT_EQ(curves.size(), 201);
  for (const BezierCurve& curve : curves) EXPECT_EQ(curve.degree(), 3);
}

TEST(BezierPaperRuns, HalvingIsAskedWhereThePapersRulesAre) {
  for (const SubdivisionSetting& setting : SubdivisionSettings()) {
    EXPECT_EQ(RuleIn(setting, "half")->AlwaysHalves(), setting.name == "certified");
    EXPECT_EQ(RuleIn(setting, "half")->Info().name, "half");
  }
}

TEST(BezierPaperRuns, ComparedRulesStayBelowTheTolerance) {
  CsvTable table({"family", "setting", "rule", "curves", "pieces_ratio", "pieces_low",
                  "pieces_high", "seconds_ratio", "seconds_low", "seconds_high", "time_wins",
                  "time_losses", "mean_pieces", "mean_rounds", "cuts_per_piece",
                  "error_over_tolerance", "failing"});
  CompareRules({FamilyCurve("walk", 12, 0), FamilyCurve("wave", 12, 0)}, {"two"}, 1, 1, &table);
  EXPECT_EQ(table.num_rows(), 17);  // 5 rules in uniform rounds, 6 adaptive, by two stops
  for (std::size_t k = 0; k < table.num_rows(); ++k) {
    EXPECT_EQ(table.Text(k, "curves"), "2");
    EXPECT_EQ(table.Text(k, "failing"), "0");
    EXPECT_GT(table.Number(k, "error_over_tolerance"), 0.0);
    EXPECT_LE(table.Number(k, "error_over_tolerance"), 1.0) << table.Text(k, "rule");
  }
  const CsvTable half = RowsOf(table, "adaptive", "half");
  ASSERT_EQ(half.num_rows(), 1);
  EXPECT_EQ(half.Text(0, "pieces_ratio"), "1");
}

}  // namespace
}  // namespace batten
