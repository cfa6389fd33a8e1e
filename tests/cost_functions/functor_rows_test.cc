#include "cost_functions/functor_rows.h"

#include <gtest/gtest.h>

#include <cstring>
#include <tuple>

#include "cost_functions/interpolation.h"
#include "tests/cost_functions/example_fit.h"

namespace batten {
namespace {

/// All that is handed out, number by number.
class Numbers final : public RowConsumer {
 public:
  explicit Numbers(const RowShape& shape) : shape_(shape) {}
  void Consume(const RowBlock& block) override {
    values.push_back(block.first_column);
    values.push_back(block.num_rows);
    const auto stride = static_cast<std::ptrdiff_t>(block.stride);
    values.insert(values.end(), block.coefficients, block.coefficients + shape_.width * stride);
    values.insert(values.end(), block.right_hand_sides,
                  block.right_hand_sides + shape_.dimension * stride);
  }
  std::vector<double> values;

 private:
  RowShape shape_;
};

template <int P, int D>
void ExpectSameBits(const ExampleFit& fit) {
  NameSpec spec;
  const Term* term = nullptr;
  OptionValues options;
  std::string error;
  ASSERT_TRUE(ParseNameSpec("interpolation", &spec, &error) &&
              TermRegistry::Global().Resolve(spec, &term, &options, &error))
      << error;
  const InterpolationResidual functor(options);
  const FunctorRows<InterpolationResidual, P, D> rows(fit.setting, fit.sites, functor);
  RowShape shape;
  shape.width = P + 1;
  shape.dimension = D;
  Numbers here(shape);
  Numbers anywhere(shape);
  const int num_groups = static_cast<int>(fit.sites.groups.size());
  rows.Stream(0.75, 0, num_groups, &here);
  rows.StreamOnAnyProcessor(0.75, 0, num_groups, &anywhere);
  ASSERT_EQ(here.values.size(), anywhere.values.size());
  ASSERT_GT(here.values.size(), 0u);
  EXPECT_EQ(
      std::memcmp(here.values.data(), anywhere.values.data(), here.values.size() * sizeof(double)),
      0);
}

// 300 points in a few spans: whole packs, the rest of one, and blocks that are full. On a processor
// without AVX2 both are one, and this says nothing.
TEST(FunctorRows, AreTheSameBitsOnEveryProcessor) {
  std::mt19937 random(20261129);
  for (const EndKnots ends : {EndKnots::kEndInterpolating, EndKnots::kPeriodic}) {
    for (const bool weighted : {false, true}) {
      constexpr int kPoints = 300;
      const auto basis = [&](int degree) { return MakeBasis({degree, ends, false}, 9, &random); };
      ExpectSameBits<3, 2>({basis(3), 2, kPoints, weighted, &random});
      ExpectSameBits<3, 1>({basis(3), 1, kPoints, weighted, &random});
      ExpectSameBits<3, 3>({basis(3), 3, kPoints, weighted, &random});
      ExpectSameBits<2, 2>({basis(2), 2, kPoints, weighted, &random});
      ExpectSameBits<5, 2>({basis(5), 2, kPoints, weighted, &random});
    }
  }
}

// Parameters in order are read pack by pack, others one by one.
TEST(FunctorRows, OfOrderedDataAreTheSameBitsOnEveryProcessor) {
  std::mt19937 random(20261130);
  ExampleFit fit(MakeBasis({3, EndKnots::kEndInterpolating, false}, 9, &random), 2, 300, false,
                 &random);
  std::sort(fit.parameters.begin(), fit.parameters.end());
  fit.sites.order.clear();
  fit.sites.groups.clear();
  GroupBySpan(fit.basis, IsNondecreasing(fit.sites.parameters, fit.sites.size), &fit.sites);
  ASSERT_TRUE(fit.sites.order.empty());
  ExpectSameBits<3, 2>(fit);
}

}  // namespace
}  // namespace batten
