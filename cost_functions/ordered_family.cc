#include "cost_functions/ordered_family.h"

namespace batten {

void OrderedFamily::Bind(const Eigen::VectorXd& x, int block, std::vector<int>* offsets,
                         std::vector<int>* sizes) const {
  inner_->Bind(Ordered(x, Order(x)), block, offsets, sizes);
}

std::unique_ptr<ceres::CostFunction> OrderedFamily::MakeCeresCostFunction(const Eigen::VectorXd& x,
                                                                          int block) const {
  return inner_->MakeCeresCostFunction(Ordered(x, Order(x)), block);
}

Eigen::VectorXd OrderedFamily::Ordered(const Eigen::VectorXd& x,
                                       const OrderedParameters& order) const {
  Eigen::VectorXd ordered = x;
  ordered.segment(begin_, count_) = order.t;
  return ordered;
}

void OrderedFamily::Seat(Eigen::VectorXd* x) const {
  // Not the inner family's seats past the ends, which are in no order: here what is at an end does
  // not count in the gradient unless E falls inwards.
  if (x->allFinite()) *x = Ordered(*x, Order(*x));
}

void OrderedFamily::KeepTogether(const Eigen::VectorXd& x, const Eigen::VectorXd& gradient,
                                 Eigen::VectorXd* direction) const {
  if (!x.allFinite()) return;
  direction->segment(begin_, count_) =
      Order(x).KeptTogether(gradient.segment(begin_, count_), direction->segment(begin_, count_));
}

bool OrderedFamily::DoEvaluate(const Eigen::VectorXd& x, int begin, int end, double* energy,
                               Eigen::VectorXd* gradient) const {
  if (!x.allFinite()) return false;
  const OrderedParameters order = Order(x);
  const Eigen::VectorXd ordered = Ordered(x, order);
  if (gradient == nullptr) {
    return inner_->Evaluate(ordered, begin, end, energy, nullptr) == Status::kOk;
  }
  Eigen::VectorXd by_t = Eigen::VectorXd::Zero(x.size());
  if (inner_->Evaluate(ordered, begin, end, energy, &by_t) != Status::kOk) return false;
  by_t.segment(begin_, count_) = order.SteepestAscent(by_t.segment(begin_, count_));
  *gradient += by_t;
  return true;
}

bool OrderedFamily::DoResiduals(const Eigen::VectorXd& x, Eigen::VectorXd* residuals) const {
  return x.allFinite() && inner_->Residuals(Ordered(x, Order(x)), residuals) == Status::kOk;
}

bool OrderedFamily::DoJacobian(const Eigen::VectorXd& x, int first_row,
                               std::vector<Eigen::Triplet<double>>* entries) const {
  return x.allFinite() && inner_->Jacobian(Ordered(x, Order(x)), first_row, entries) == Status::kOk;
}

bool OrderedFamily::DoAddHessianTimes(const Eigen::VectorXd& x, const Eigen::VectorXd& direction,
                                      Eigen::VectorXd* product) const {
  if (!x.allFinite()) return false;
  const OrderedParameters order = Order(x);
  Eigen::VectorXd along = direction;
  along.segment(begin_, count_) = order.Apply(direction.segment(begin_, count_));
  Eigen::VectorXd by_t = Eigen::VectorXd::Zero(x.size());
  if (inner_->AddHessianTimes(Ordered(x, order), along, &by_t) != Status::kOk) return false;
  by_t.segment(begin_, count_) = order.Apply(by_t.segment(begin_, count_));
  *product += by_t;
  return true;
}

}  // namespace batten
