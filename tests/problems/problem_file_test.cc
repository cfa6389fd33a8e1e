// ReadProblemFile, through FindProblem: what a problem file may say and how the rest is answered.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "problems/catalogue.h"
#include "tests/problems/scratch_folder.h"

namespace batten {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class ProblemFile : public ::testing::Test {
 protected:
  ProblemFile() { folder_.Write("points.csv", "x,y,t\n0,1,0\n2,3,0.1\n4,7,0.5\n5,5,0.7\n9,1,1\n"); }
  CatalogueEntry Read(const std::string& text) const {
    CatalogueEntry entry;
    std::string error;
    EXPECT_TRUE(FindProblem(folder_.Write("problem.json", text), &entry, &error)) << error;
    return entry;
  }
  /// The error without the path.
  std::string Refusal(const std::string& text) const {
    const std::string path = folder_.Write("problem.json", text);
    CatalogueEntry entry;
    entry.name = "as before";
    std::string error;
    EXPECT_FALSE(FindProblem(path, &entry, &error)) << text;
    EXPECT_EQ(entry.name, "as before");
    EXPECT_THAT(error, StartsWith(path + ": "));
    EXPECT_THAT(error, Not(HasSubstr("\n")));
    return error.substr(std::min(error.size(), path.size() + 2));
  }
  /// A problem file with `spline` in place of its spline, and `more` at the end.
  static std::string WithSpline(const std::string& spline, const std::string& more = "") {
    return R"({"name": "a", "data": "points.csv", "spline": {)" + spline + "}" + more + "}";
  }
  const ScratchFolder folder_;
};

TEST_F(ProblemFile, TakesDefaultsForWhatIsNotSaid) {
  const CatalogueEntry entry = Read(WithSpline(R"("control_points": 4)"));
  EXPECT_EQ(entry.name, "a");
  EXPECT_EQ(entry.spec.name, "a");
  EXPECT_EQ(entry.spec.degree, 3);
  EXPECT_FALSE(entry.spec.closed);
  EXPECT_EQ(entry.spec.control_points, 4);
  EXPECT_EQ(entry.spec.parameters, Parameterization::kUniform);
  EXPECT_EQ(entry.spec.knots, KnotRule::kUniform);
  EXPECT_EQ(entry.spec.ends, EndKnots::kEndInterpolating);
  EXPECT_EQ(entry.spec.start, "data");
  EXPECT_TRUE(entry.spec.terms.empty());  // those usual for the kind of parameters
  EXPECT_TRUE(std::isnan(entry.reference_energy));
}

TEST_F(ProblemFile, ReadsEverythingThatCanBeSaid) {
  const CatalogueEntry entry = Read(R"({
    "name": "all-of_it2", "summary": "a summary", "data": "points.csv",
    "spline": {"degree": 2, "closed": false, "control_points": 5, "knots": "uniform",
               "ends": "floating", "domain": [-1, 1.5]},
    "parameters": "given", "terms": ["interpolation/weight=2", "interpolation/loss=huber"],
    "start": "centroid", "reference": {"energy": 1.25e-3, "source": "by hand"},
    "citation": "someone"})");
  EXPECT_EQ(entry.name, "all-of_it2");
  EXPECT_EQ(entry.summary, "a summary");
  EXPECT_EQ(entry.citation, "someone");
  EXPECT_EQ(entry.data_path, folder_.path() / "points.csv");
  EXPECT_EQ(entry.spec.degree, 2);
  EXPECT_EQ(entry.spec.ends, EndKnots::kFloating);
  EXPECT_EQ(entry.spec.parameters, std::nullopt);
  EXPECT_EQ(entry.spec.domain, std::pair(-1.0, 1.5));
  EXPECT_EQ(entry.spec.terms.at(1).ToString(), "interpolation/loss=huber");
  EXPECT_EQ(entry.spec.start, "centroid");
  EXPECT_EQ(entry.reference_energy, 1.25e-3);
  std::string error;
  EXPECT_NE(LoadProblem(entry, &error), nullptr) << error;
}

TEST_F(ProblemFile, TakesKnotsAsAList) {
  const CatalogueEntry entry =
      Read(WithSpline(R"("degree": 2, "knots": [0, 0, 0, 0.25, 1, 1, 1])"));
  EXPECT_EQ(entry.spec.control_points, 4);
  EXPECT_THAT(entry.spec.given_knots, ElementsAre(0, 0, 0, 0.25, 1, 1, 1));
  std::string error;
  EXPECT_NE(LoadProblem(entry, &error), nullptr) << error;
}

TEST_F(ProblemFile, NamesTheFileWhereTheFitCannotBeFormed) {
  const CatalogueEntry entry =
      Read(WithSpline(R"("control_points": 4, "domain": [0.3, 1])", R"(, "parameters": "given")"));
  std::string error;
  EXPECT_EQ(LoadProblem(entry, &error), nullptr);
  EXPECT_THAT(error, HasSubstr("problem.json: parameter 0 of data point 1 is outside the domain"));
}

TEST_F(ProblemFile, RefusesNumbersOutOfRange) {
  EXPECT_EQ(Refusal(WithSpline(R"("degree": 12, "control_points": 4)")),
            "/spline/degree: found 12; allowed: 1 to 9");
  EXPECT_EQ(Refusal(WithSpline(R"("degree": 0, "control_points": 4)")),
            "/spline/degree: found 0; allowed: 1 to 9");
  EXPECT_EQ(Refusal(WithSpline(R"("degree": 5, "control_points": 5)")),
            "/spline/control_points: found 5; allowed: 6 to 10000000");
  EXPECT_EQ(Refusal(WithSpline(R"("closed": true, "control_points": 0)")),
            "/spline/control_points: found 0; allowed: 1 to 10000000");
  EXPECT_EQ(Refusal(WithSpline(R"("control_points": 18446744073709551615)")),
            "/spline/control_points: found 18446744073709551615; allowed: 4 to 10000000");
  EXPECT_EQ(Refusal(WithSpline(R"("control_points": 4)", R"(, "reference": {"energy": -1})")),
            "/reference/energy: found -1; allowed: at least 0");
  // With moving parameters no least energy is known, with fixed ones no other is asked for.
  const auto with_reference = [&](const std::string& kind, const std::string& key) {
    return Refusal(
        WithSpline(R"("control_points": 4)",
                   R"(, "parameter_kind": ")" + kind + R"(", "reference": {")" + key + R"(": 1})"));
  };
  EXPECT_THAT(with_reference("free", "energy"), HasSubstr("best_known"));
  EXPECT_THAT(with_reference("projected", "energy"), HasSubstr("best_known"));
  EXPECT_THAT(with_reference("fixed", "best_known"), HasSubstr("energy"));
}

TEST_F(ProblemFile, TakesWeightsOfSpansForFairingAndGuards) {
  // Three spans of an open curve of degree 2.
  const std::string spline = R"("degree": 2, "control_points": 5)";
  const char* const faired[] = {
      R"(, "terms": ["interpolation", "fairing/weight=1e-3"])",
      R"(, "parameter_kind": "free", "start": "circle", "guard": "bending")"};
  for (const char* more : faired) {
    const auto energy_of_fairing = [&](const std::string& weights) {
      const CatalogueEntry entry =
          Read(WithSpline(spline, more + (R"(, "span_weights": )" + weights)));
      std::string error;
      const auto problem = LoadProblem(entry, &error);
      EXPECT_NE(problem, nullptr) << error;
      if (problem == nullptr) return 0.0;
      const auto& term = problem->terms().back();
      EXPECT_THAT(term.name, HasSubstr("fairing"));
      double energy = 0.0;
      term.family->Evaluate(problem->start(), 0, term.family->size(), &energy, nullptr);
      return energy;
    };
    // E is a sum over spans.
    const double all = energy_of_fairing("[1, 1, 1]");
    const double first = energy_of_fairing("[1, 0, 0]");
    const double others = energy_of_fairing("[0, 1, 1]");
    EXPECT_GT(first, 1e-3 * all);
    EXPECT_GT(others, 1e-3 * all);
    EXPECT_NEAR(first + others, all, 1e-12 * all);
    EXPECT_NEAR(energy_of_fairing("[2.5, 1, 1]"), all + 1.5 * first, 1e-12 * all);
    EXPECT_EQ(energy_of_fairing("[0, 0, 0]"), 0.0);
  }
}

TEST_F(ProblemFile, RefusesWeightsOfSpansThatAreNone) {
  const std::string spline = R"("degree": 2, "control_points": 5)";
  const std::string faired = R"(, "terms": ["interpolation", "fairing"], "span_weights": )";
  EXPECT_EQ(Refusal(WithSpline(spline, faired + "[1, -1, 1]")),
            "/span_weights/1: found -1; allowed: a number >= 0");
  EXPECT_EQ(Refusal(WithSpline(spline, faired + "[1, \"1\", 1]")),
            "/span_weights/1: found \"1\"; allowed: a number");
  EXPECT_EQ(Refusal(WithSpline(spline, faired + "[]")),
            "/span_weights: found an empty list; allowed: a list of numbers");
  EXPECT_THAT(Refusal(WithSpline(spline, faired + "3")), HasSubstr("/span_weights: found 3"));
  EXPECT_THAT(Refusal(WithSpline(spline, R"(, "span_weights": [1, 1, 1])")),
              HasSubstr("nothing, where there is neither a fairing term nor a guard"));
  // How many there are is seen when the problem is made.
  std::string error;
  EXPECT_EQ(LoadProblem(Read(WithSpline(spline, faired + "[1, 1]")), &error), nullptr);
  EXPECT_THAT(error, EndsWith("problem.json: found 2 weights of spans; the curve has 3 spans that "
                              "are not empty"));
}

TEST_F(ProblemFile, RefusesWrongTypes) {
  EXPECT_EQ(Refusal(WithSpline(R"("degree": 3.5, "control_points": 4)")),
            "/spline/degree: found 3.5; allowed: 1 to 9, whole numbers");
  EXPECT_EQ(Refusal(WithSpline(R"("degree": "3", "control_points": 4)")),
            "/spline/degree: found \"3\"; allowed: 1 to 9, whole numbers");
  EXPECT_EQ(Refusal(WithSpline(R"("closed": 1, "control_points": 4)")),
            "/spline/closed: found 1; allowed: true, false");
  EXPECT_EQ(Refusal("[1, 2]"), "/: found a list; allowed: an object");
  EXPECT_EQ(Refusal(R"({"name": "a", "data": "points.csv", "spline": null})"),
            "/spline: found null; allowed: an object");
  EXPECT_EQ(Refusal(WithSpline(R"("control_points": 4)", R"(, "terms": "interpolation")")),
            "/terms: found \"interpolation\"; allowed: a list of texts");
  EXPECT_EQ(Refusal(WithSpline(R"("control_points": 4)", R"(, "terms": ["interpolation", {}])")),
            "/terms/1: found an object; allowed: text");
  EXPECT_EQ(Refusal(WithSpline(R"("control_points": 4)", R"(, "terms": [])")),
            "/terms: found an empty list; allowed: a list of texts");
  EXPECT_EQ(Refusal(WithSpline(R"("control_points": 4)", R"(, "citation": "two\nlines")")),
            "/citation: found \"two\\nlines\"; allowed: text on one line");
}

TEST_F(ProblemFile, RefusesUnknownKeysAndWords) {
  EXPECT_THAT(Refusal(WithSpline(R"("degre": 3)")),
              HasSubstr("/spline: unknown key \"degre\"; did you mean degree? known: degree, "));
  EXPECT_THAT(Refusal(WithSpline("", R"(, "term": [])")),
              HasSubstr("/: unknown key \"term\"; did you mean terms? known: name, "));
  EXPECT_EQ(Refusal(WithSpline(R"("control_points": 4, "knots": "unifrom")")),
            "/spline/knots: found \"unifrom\"; allowed: uniform, averaged; did you mean uniform?");
  EXPECT_EQ(
      Refusal(WithSpline(R"("control_points": 4)", R"(, "parameters": "chord")")),
      "/parameters: found \"chord\"; allowed: uniform, chord_length, centripetal, given; did you "
      "mean chord_length?");
  EXPECT_THAT(Refusal(WithSpline(R"("control_points": 4)", R"(, "terms": ["interpolatoin"])")),
              HasSubstr("/terms/0: unknown term \"interpolatoin\"; did you mean interpolation?"));
  EXPECT_THAT(
      Refusal(WithSpline(R"("control_points": 4)", R"(, "terms": ["interpolation/weight=-1"])")),
      HasSubstr("/terms/0: option weight of interpolation is -1"));
}

TEST_F(ProblemFile, RefusesWhatIsMissing) {
  EXPECT_EQ(Refusal("{}"), "/name: found nothing; allowed: text on one line");
  EXPECT_EQ(Refusal(R"({"name": "a", "data": "points.csv"})"),
            "/spline: found nothing; allowed: an object");
  EXPECT_EQ(Refusal(WithSpline("")),
            "/spline/control_points: found nothing; allowed: 4 to 10000000");
  EXPECT_THAT(Refusal(R"({"name": "a", "data": "none.csv", "spline": {"control_points": 4}})"),
              HasSubstr("/data: found \"none.csv\"; allowed: a file in " + folder_.path().string() +
                        " or "));
  EXPECT_EQ(Refusal(R"({"name": "a b", "data": "points.csv"})"),
            "/name: found \"a b\"; allowed: letters, digits, _ and -");
}

TEST_F(ProblemFile, RefusesWhatDoesNotGoTogether) {
  EXPECT_EQ(Refusal(WithSpline(R"("closed": true, "control_points": 4, "ends": "floating")")),
            "/spline/ends: found \"floating\"; allowed: nothing, where the spline is closed");
  EXPECT_EQ(Refusal(WithSpline(R"("control_points": 4, "domain": [0, 2])")),
            "/spline/domain: found a list; allowed: nothing, unless the parameters are given");
  EXPECT_EQ(
      Refusal(WithSpline(R"("control_points": 4, "domain": [2, 0])", R"(, "parameters": "given")")),
      "/spline/domain: found a list; allowed: [begin, end] with begin < end");
  EXPECT_EQ(Refusal(WithSpline(R"("degree": 1, "control_points": 4, "knots": [0, 0, 1, 1])")),
            "/spline/control_points: found 4; allowed: 2, as the given knots make");
  EXPECT_EQ(Refusal(WithSpline(R"("degree": 1, "ends": "floating", "knots": [0, 0, 1, 1])")),
            "/spline/ends: found \"floating\"; allowed: nothing, where the knots are given");
  EXPECT_THAT(Refusal(WithSpline(R"("degree": 1, "knots": [0, 1, 0, 1])")),
              StartsWith("/spline/knots: "));
}

TEST_F(ProblemFile, RefusesTextThatIsNotOneJsonValue) {
  EXPECT_THAT(Refusal("{\"name\": \n  oops}"), StartsWith("line 2, column 3: "));
  EXPECT_THAT(Refusal("{} {}"), StartsWith("line 1, column 4: "));
  EXPECT_THAT(Refusal("{\"name\": 1e999}"), HasSubstr("1e999"));
  EXPECT_THAT(Refusal(""), HasSubstr("found nothing to read"));
  EXPECT_EQ(Refusal(R"({"name": "a", "spline": {"degree": 3, "degree": 4}})"),
            "/spline: key \"degree\" stands twice; allowed: once");
  EXPECT_EQ(Refusal(R"({"a": 1, "a": 2})"), "/: key \"a\" stands twice; allowed: once");
  // Alike keys in different objects are none that stands twice.
  EXPECT_EQ(Refusal(R"({"a": [{"k": 1}, [3, []], {"k": {"k": [5, {"b": 1, "c": 2, "b": 3}]}}]})"),
            "/a/2/k/k/1: key \"b\" stands twice; allowed: once");
  EXPECT_THAT(Refusal("{\"na\xff\x01me\": 1}"), StartsWith("line 1, column "));
  // Deeply nested text must neither be printed nor overflow the stack.
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  EXPECT_EQ(Refusal(deep), "/: found a list; allowed: an object");
}

TEST_F(ProblemFile, RefusesAPathWhereNoFileIs) {
  CatalogueEntry entry;
  std::string error;
  EXPECT_FALSE(FindProblem("./no_such.json", &entry, &error));
  EXPECT_EQ(error, "./no_such.json: found no such file that can be read");
  EXPECT_FALSE(FindProblem(folder_.path(), &entry, &error));
  EXPECT_THAT(error, EndsWith("allowed: a file with JSON text"));
}

}  // namespace
}  // namespace batten
