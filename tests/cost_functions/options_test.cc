#include "cost_functions/options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

namespace batten {
namespace {

const double kInfinity = std::numeric_limits<double>::infinity();

std::vector<OptionInfo> LbfgsOptions() {
  return {OptionInfo::Integer("memory", 10, 3, 20, "Pairs kept."),
          OptionInfo::Word("wolfe", "strong", {"weak", "strong"}, "Line search condition."),
          OptionInfo::Real("weight", 1.0, 0.0, kInfinity, "Factor."),
          OptionInfo::Real("radius", kInfinity, 0.5, kInfinity, "Largest step.")};
}

NameSpec Parsed(const std::string& text) {
  NameSpec spec;
  std::string error;
  EXPECT_TRUE(ParseNameSpec(text, &spec, &error)) << error;
  return spec;
}

std::string ParseError(const std::string& text) {
  NameSpec spec;
  std::string error;
  EXPECT_FALSE(ParseNameSpec(text, &spec, &error)) << text;
  EXPECT_TRUE(spec.name.empty()) << "changed by a refused text";
  return error;
}

std::string ResolveError(const std::string& text) {
  OptionValues values;
  std::string error;
  EXPECT_FALSE(ResolveOptions(LbfgsOptions(), Parsed(text), &values, &error)) << text;
  EXPECT_TRUE(values.ToText().empty()) << "changed by a refused spec";
  return error;
}

OptionValues Resolved(const std::string& text) {
  OptionValues values;
  std::string error;
  EXPECT_TRUE(ResolveOptions(LbfgsOptions(), Parsed(text), &values, &error)) << error;
  return values;
}

TEST(OptionInfo, WritesItsRangeAndDefaultAsText) {
  const std::vector<OptionInfo> infos = LbfgsOptions();
  EXPECT_EQ(infos[0].RangeText(), "3 to 20");
  EXPECT_EQ(infos[0].DefaultText(), "10");
  EXPECT_EQ(infos[1].RangeText(), "one of weak, strong");
  EXPECT_EQ(infos[1].DefaultText(), "strong");
  EXPECT_EQ(infos[2].RangeText(), "at least 0");
  EXPECT_EQ(infos[3].RangeText(), "0.5 to inf");
  EXPECT_EQ(infos[3].DefaultText(), "inf");
  const int largest = std::numeric_limits<int>::max();
  const int lowest = std::numeric_limits<int>::min();
  EXPECT_EQ(OptionInfo::Integer("seed", 1, 0, largest, "").RangeText(), "at least 0");
  EXPECT_EQ(OptionInfo::Integer("seed", 1, lowest, largest, "").RangeText(), "any integer");
  EXPECT_EQ(OptionInfo::Real("shift", 0, -kInfinity, 2.5, "").RangeText(), "at most 2.5");
  EXPECT_EQ(OptionInfo::Real("shift", 0, -kInfinity, kInfinity, "").RangeText(), "any number");
}

TEST(OptionInfo, DiesOfADefaultOutsideItsOwnRange) {
  EXPECT_DEATH(OptionInfo::Real("weight", -1.0, 0.0, 1.0, ""), "weight");
  EXPECT_DEATH(OptionInfo::Integer("memory", 2, 3, 20, ""), "memory");
  EXPECT_DEATH(OptionInfo::Word("wolfe", "none", {"weak"}, ""), "wolfe");
}

TEST(OptionValues, HoldsTheDefaultsAndListsThemInAlphabeticalOrder) {
  const OptionValues values(LbfgsOptions());
  EXPECT_EQ(values.Integer("memory"), 10);
  EXPECT_EQ(values.Real("memory"), 10.0);
  EXPECT_EQ(values.Word("wolfe"), "strong");
  const std::map<std::string, std::string> expected = {
      {"memory", "10"}, {"radius", "inf"}, {"weight", "1"}, {"wolfe", "strong"}};
  EXPECT_EQ(values.ToText(), expected);
}

TEST(OptionValues, ThrowsAtANameThatIsNotThere) {
  const OptionValues values(LbfgsOptions());
  const auto what = [](const auto& ask) -> std::string {
    try {
      ask();
    } catch (const std::logic_error& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_EQ(what([&] { values.Real("memroy"); }),
            "asks for an option memroy that it has not declared; did you mean memory?");
  EXPECT_EQ(what([&] { values.Word("memory"); }),
            "asks for an option memory that it has not declared; did you mean wolfe?");
  EXPECT_EQ(what([] { OptionValues().Real("x"); }),
            "asks for an option x that it has not declared");
  EXPECT_DEATH(values.Integer("radius"), "radius");
}

TEST(OptionList, SaysWhatIsWrongWithIt) {
  EXPECT_EQ(WhyNoOptionList(LbfgsOptions()), "");
  const auto number = [](const std::string& name) {
    return OptionInfo::Real(name, 0.0, -1.0, 1.0, "help");
  };
  EXPECT_EQ(WhyNoOptionList({number("a"), number("b"), number("a")}), "has two options named a");
  EXPECT_EQ(WhyNoOptionList({number("a=b")}),
            "has an option named \"a=b\"; allowed: letters, digits, _ and -");
  EXPECT_EQ(WhyNoOptionList({OptionInfo::Word("a", "x.5", {"x.5", ""}, "help")}),
            "has an option a with the word \"\"; allowed: letters, digits, _, -, . and +");
}

TEST(ParseNameSpec, ReadsNameOptionsAndWrappedMethod) {
  const NameSpec spec = Parsed("anderson/window=5/mixing=1.5e+2:banded-qr/order=left_first");
  EXPECT_EQ(spec.name, "anderson");
  ASSERT_EQ(spec.options.size(), 2u);
  EXPECT_EQ(spec.options[0], std::make_pair(std::string("window"), std::string("5")));
  EXPECT_EQ(spec.options[1], std::make_pair(std::string("mixing"), std::string("1.5e+2")));
  ASSERT_NE(spec.wrapped, nullptr);
  EXPECT_EQ(spec.wrapped->name, "banded-qr");
  EXPECT_EQ(spec.wrapped->options[0].second, "left_first");
  EXPECT_EQ(spec.wrapped->wrapped, nullptr);
}

TEST(ParseNameSpec, WritesBackWhatItReads) {
  for (const char* text : {"cg", "lbfgs/memory=10/wolfe=weak", "anderson/window=5:pdm",
                           "best_of/starts=20:irls/loss=tukey:banded_qr", "f/weight=-1e-3"}) {
    EXPECT_EQ(Parsed(text).ToString(), text);
  }
}

TEST(ParseNameSpec, SaysWhatItFoundWhereAndWhatIsAllowed) {
  EXPECT_EQ(ParseError(""), "found the end of \"\"; allowed: a name of letters, digits, _ and -");
  EXPECT_EQ(ParseError("lbfgs//memory=1"),
            "found \"/\" at character 7 of \"lbfgs//memory=1\"; allowed: an option as NAME=VALUE");
  EXPECT_EQ(ParseError("lbfgs/memory"),
            "found the end of \"lbfgs/memory\"; allowed: = and a value after option memory");
  EXPECT_EQ(ParseError("lbfgs/memory="),
            "found the end of \"lbfgs/memory=\"; allowed: a value of letters, digits, _ - . +");
  EXPECT_EQ(ParseError("a/b=1/c=2/b=1"),
            "found \"b\" at character 11 of \"a/b=1/c=2/b=1\"; allowed: option b once");
  EXPECT_EQ(ParseError("a b"),
            "found \" \" at character 2 of \"a b\"; allowed: NAME[/OPTION=VALUE]...[:WRAPPED]");
}

TEST(ParseNameSpec, RefusesEverythingOutsideTheGrammar) {
  for (const char* text :
       {":", "a:", ":a", "a/", "/a=1", "a/=1", "a/b=1=2", "a,b", "a.b", "a/b.c=1", "a/b=1 ", " a",
        "a\n", "a/b=\"1\"", "a/b=$(c)", "a::b", "\xC3\xA9"}) {
    const std::string error = ParseError(text);
    for (const char c : error) EXPECT_TRUE(c >= 32 && c < 127) << error;
  }
}

TEST(ParseNameSpec, KeepsTheSameOptionOfDifferentMethodsApart) {
  EXPECT_EQ(Parsed("a/weight=1:b/weight=2").wrapped->options[0].second, "2");
}

TEST(ParseNameSpec, RefusesAnEndlessChain) {
  std::string text = "a";
  for (int i = 1; i < 16; ++i) text += ":a";
  EXPECT_EQ(Parsed(text).ToString(), text);
  EXPECT_NE(ParseError(text + ":a").find("at most 16 names"), std::string::npos);
  for (int i = 0; i < 1000000; ++i) text += ":a";
  EXPECT_LT(ParseError(text).size(), 300u);
}

TEST(ParseNameSpecList, SplitsAtCommas) {
  std::vector<NameSpec> specs;
  std::string error;
  ASSERT_TRUE(ParseNameSpecList("cg,anderson/window=5:pdm,cg", &specs, &error)) << error;
  ASSERT_EQ(specs.size(), 3u);
  EXPECT_EQ(specs[1].ToString(), "anderson/window=5:pdm");
  EXPECT_EQ(specs[2].name, "cg");
}

TEST(ParseNameSpecList, RefusesGapsAndAnEmptyList) {
  for (const char* text : {"", ",", "cg,", ",cg", "cg,,pdm", "cg, pdm", "cg;pdm"}) {
    std::vector<NameSpec> specs(1);
    std::string error;
    EXPECT_FALSE(ParseNameSpecList(text, &specs, &error)) << text;
    EXPECT_NE(error.find("; allowed: "), std::string::npos) << error;
    EXPECT_EQ(specs.size(), 1u) << "changed by a refused text";
  }
}

TEST(ResolveOptions, OverwritesDefaults) {
  const OptionValues values = Resolved("lbfgs/memory=3/wolfe=weak/weight=+.5");
  EXPECT_EQ(values.Integer("memory"), 3);
  EXPECT_EQ(values.Word("wolfe"), "weak");
  EXPECT_EQ(values.Real("weight"), 0.5);
  EXPECT_EQ(values.Real("radius"), kInfinity);
}

TEST(ResolveOptions, TakesInfinityOnlyWhereItIsTheDefault) {
  EXPECT_EQ(Resolved("lbfgs/radius=inf").Real("radius"), kInfinity);
  EXPECT_EQ(ResolveError("lbfgs/weight=inf"), "option weight of lbfgs is inf, must be at least 0");
  EXPECT_EQ(ResolveError("lbfgs/radius=-inf"),
            "option radius of lbfgs is -inf, must be 0.5 to inf");
}

TEST(ResolveOptions, AnswersAnUnknownOptionWithTheNearestAndItsRange) {
  EXPECT_EQ(ResolveError("lbfgs/memroy=5"),
            "lbfgs has no option \"memroy\"; did you mean memory (3 to 20)? "
            "known: memory, wolfe, weight, radius");
  OptionValues values;
  std::string error;
  EXPECT_FALSE(ResolveOptions({}, Parsed("cg/memory=5"), &values, &error));
  EXPECT_EQ(error, "cg has no option \"memory\"; it has none");
}

TEST(ResolveOptions, AnswersAValueOutsideItsRangeWithTheRange) {
  EXPECT_EQ(ResolveError("lbfgs/memory=2"),
            "option memory of lbfgs is 2, must be an integer, 3 to 20");
  EXPECT_EQ(ResolveError("lbfgs/wolfe=wek"),
            "option wolfe of lbfgs is wek, must be one of weak, strong; did you mean weak?");
  for (const char* text : {"memory=21", "memory=3.5", "memory=x", "memory=5x", "weight=-1e-300",
                           "weight=nan", "weight=1e400", "wolfe=Weak", "memory=1e300"}) {
    EXPECT_NE(ResolveError(std::string("lbfgs/") + text).find("must be"), std::string::npos);
  }
}

TEST(NearestName, CountsASwapOnceAndPrefersTheFirstOfEquals) {
  EXPECT_EQ(NearestName("lbgfs", {"cg", "gim", "lbfgs"}), "lbfgs");
  EXPECT_EQ(NearestName("ab", {"xb", "ba", "ax"}), "xb");
  EXPECT_EQ(NearestName("abcd", {"xycd", "badc", "abdc"}), "abdc");
  EXPECT_EQ(NearestName("", {"abc", "a"}), "a");
  EXPECT_EQ(NearestName("cg", {}), "");
}

TEST(UnknownNameMessage, NamesTheNearestAndAllKnown) {
  EXPECT_EQ(UnknownNameMessage("solver", "lbgfs", {"cg", "gim", "lbfgs"}),
            "unknown solver \"lbgfs\"; did you mean lbfgs? known: cg, gim, lbfgs");
  EXPECT_EQ(UnknownNameMessage("reader", "a\nb", {}), "unknown reader \"a\\x0ab\"; none is known");
}

TEST(NumberText, IsShort) {
  EXPECT_EQ(NumberText(0.1), "0.1");
  EXPECT_EQ(NumberText(10.0), "10");
  EXPECT_EQ(NumberText(-0.0), "-0");
  EXPECT_EQ(NumberText(1e-8), "1e-08");
  EXPECT_EQ(NumberText(kInfinity), "inf");
  EXPECT_EQ(NumberText(-kInfinity), "-inf");
  EXPECT_EQ(NumberText(-std::nan("")), "nan");
}

TEST(NumberText, ReadsBackToTheSameBits) {
  std::mt19937_64 random(20240611);
  for (int i = 0; i < 100000; ++i) {
    const std::uint64_t bits = random();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof(value));
    if (!std::isfinite(value)) continue;
    double back = 0.0;
    ASSERT_TRUE(ParseNumber(NumberText(value), &back)) << NumberText(value);
    ASSERT_EQ(std::memcmp(&back, &value, sizeof(value)), 0) << NumberText(value);
  }
}

TEST(ParseNumber, ReadsWholeFiniteNumbersOnly) {
  double value = 7.0;
  for (const char* text : {"", "+", "-", ".", "+-1", "++1", "1 ", " 1", "1x", "1,5", "0x10", "1e",
                           "inf", "nan", "1e400", "-1e400", "1e99999", "1.0D5", "one"}) {
    EXPECT_FALSE(ParseNumber(text, &value)) << text;
    EXPECT_EQ(value, 7.0) << text;
  }
  EXPECT_FALSE(ParseNumber(std::string("1\0", 2), &value));
  EXPECT_TRUE(ParseNumber("+1.5e+3", &value));
  EXPECT_EQ(value, 1500.0);
  EXPECT_TRUE(ParseNumber("4.9e-324", &value));
  EXPECT_EQ(value, std::numeric_limits<double>::denorm_min());
  EXPECT_TRUE(ParseNumber("-1e-400", &value));
  EXPECT_EQ(value, 0.0);
}

}  // namespace
}  // namespace batten
