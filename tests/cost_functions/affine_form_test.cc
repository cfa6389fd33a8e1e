#include "cost_functions/affine_form.h"

#include <gtest/gtest.h>

#include "cost_functions/pack.h"

namespace batten {
namespace {

using Form = AffineForm<double, 3>;

// Numbers whose sums and products are exact, so that equality is meant to the last bit.
Form SomeForm() {
  Form form(0.75);
  form.coefficient[0] = -2.5;
  form.coefficient[2] = 4.0;
  return form;
}

void ExpectForm(const Form& form, double constant, double first, double second, double third) {
  EXPECT_EQ(form.constant, constant);
  EXPECT_EQ(form.coefficient[0], first);
  EXPECT_EQ(form.coefficient[1], second);
  EXPECT_EQ(form.coefficient[2], third);
}

double Lane(const Pack& pack, int lane) {
  alignas(32) double lanes[kRowPack];
  pack.Store(lanes);
  return lanes[lane];
}

TEST(AffineForm, OfANumberHasNoVariable) { ExpectForm(Form(-1.25), -1.25, 0.0, 0.0, 0.0); }

TEST(AffineForm, OfAVariableIsThatVariable) { ExpectForm(Form::Variable(1), 0.0, 0.0, 1.0, 0.0); }

TEST(AffineForm, AddsFormsTermByTerm) {
  const Form b = Form::Variable(1) * 0.5 + 2.0;
  ExpectForm(SomeForm() + b, 2.75, -2.5, 0.5, 4.0);
  ExpectForm(SomeForm() - b, -1.25, -2.5, -0.5, 4.0);
  ExpectForm(-SomeForm(), -0.75, 2.5, 0.0, -4.0);
}

TEST(AffineForm, AddsNumbersToTheConstantOnly) {
  ExpectForm(SomeForm() + 3.0, 3.75, -2.5, 0.0, 4.0);
  ExpectForm(3.0 + SomeForm(), 3.75, -2.5, 0.0, 4.0);
  ExpectForm(SomeForm() - 3.0, -2.25, -2.5, 0.0, 4.0);
  ExpectForm(3.0 - SomeForm(), 2.25, 2.5, 0.0, -4.0);
}

TEST(AffineForm, MultipliesEveryTermByANumber) {
  ExpectForm(SomeForm() * -2.0, -1.5, 5.0, 0.0, -8.0);
  ExpectForm(-2.0 * SomeForm(), -1.5, 5.0, 0.0, -8.0);
  ExpectForm(SomeForm() / 4.0, 0.1875, -0.625, 0.0, 1.0);
}

TEST(AffineForm, UpdatesInPlaceAsItsOperatorsDo) {
  Form form = SomeForm();
  form += Form::Variable(0);
  ExpectForm(form, 0.75, -1.5, 0.0, 4.0);
  form -= Form::Variable(2) * 3.0;
  ExpectForm(form, 0.75, -1.5, 0.0, 1.0);
  form *= 2.0;
  ExpectForm(form, 1.5, -3.0, 0.0, 2.0);
}

TEST(AffineForm, IsTheDerivativeOfWhatAFunctorComputes) {
  // 2 (x0 - 0.5) - (x1 + x2 / 4) + 1, as a residual would write it.
  const auto residual = [](const auto& x0, const auto& x1, const auto& x2) {
    return 2.0 * (x0 - 0.5) - (x1 + x2 / 4.0) + 1.0;
  };
  const Form form = residual(Form::Variable(0), Form::Variable(1), Form::Variable(2));
  ExpectForm(form, residual(0.0, 0.0, 0.0), 2.0, -1.0, -0.25);
}

TEST(AffineForm, InPacksComputesEveryLaneByItself) {
  using PackForm = AffineForm<Pack, 2>;
  const double factors[] = {1.0, -2.0, 0.5, 4.0};
  const Pack factor = Pack::Gather(factors, 1);
  const PackForm form = factor * (PackForm::Variable(0) - 1.0) + PackForm::Variable(1) * 0.25;
  for (int lane = 0; lane < kRowPack; ++lane) {
    EXPECT_EQ(Lane(form.constant, lane), -factors[lane]);
    EXPECT_EQ(Lane(form.coefficient[0], lane), factors[lane]);
    EXPECT_EQ(Lane(form.coefficient[1], lane), 0.25);
  }
}

TEST(AffineForm, InPacksStandsForACombinationOfValues) {
  using PackForm = AffineForm<Pack, 3>;
  const Pack values[] = {Pack(1.5), Pack(-2.0)};
  const PackForm form = PackForm::Combination(values, 2);
  for (int lane = 0; lane < kRowPack; ++lane) {
    EXPECT_EQ(Lane(form.constant, lane), 0.0);
    EXPECT_EQ(Lane(form.coefficient[0], lane), 1.5);
    EXPECT_EQ(Lane(form.coefficient[1], lane), -2.0);
    EXPECT_EQ(Lane(form.coefficient[2], lane), 0.0);
  }
}

TEST(Pack, GathersAndStoresLaneByLane) {
  const double source[] = {0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5};
  const std::ptrdiff_t lanes[] = {3, 0, 2, 1};
  alignas(32) double target[kRowPack];
  Pack::Gather(source, 2).Store(target);
  for (int i = 0; i < kRowPack; ++i) EXPECT_EQ(target[i], source[2 * i]);
  Pack::Gather(source, lanes, 2).Store(target);
  for (int i = 0; i < kRowPack; ++i) EXPECT_EQ(target[i], source[2 * lanes[i]]);
}

TEST(Pack, ComputesEveryLaneAsADouble) {
  const double a_lanes[] = {0.3, -1.7, 2.9, 1e-3};
  const double b_lanes[] = {7.1, 0.6, -0.2, 1e5};
  const Pack a = Pack::Gather(a_lanes, 1);
  const Pack b = Pack::Gather(b_lanes, 1);
  for (int i = 0; i < kRowPack; ++i) {
    EXPECT_EQ(Lane(a + b, i), a_lanes[i] + b_lanes[i]);
    EXPECT_EQ(Lane(a - b, i), a_lanes[i] - b_lanes[i]);
    EXPECT_EQ(Lane(a * b, i), a_lanes[i] * b_lanes[i]);
    EXPECT_EQ(Lane(a / b, i), a_lanes[i] / b_lanes[i]);
    EXPECT_EQ(Lane(-a, i), -a_lanes[i]);
    EXPECT_EQ(Lane(a + 0.1, i), a_lanes[i] + 0.1);
    EXPECT_EQ(Lane(a - 0.1, i), a_lanes[i] - 0.1);
    EXPECT_EQ(Lane(a * 0.1, i), a_lanes[i] * 0.1);
    EXPECT_EQ(Lane(a / 0.1, i), a_lanes[i] / 0.1);
    EXPECT_EQ(Lane(0.1 + a, i), 0.1 + a_lanes[i]);
    EXPECT_EQ(Lane(0.1 - a, i), 0.1 - a_lanes[i]);
    EXPECT_EQ(Lane(0.1 * a, i), 0.1 * a_lanes[i]);
  }
}

}  // namespace
}  // namespace batten
