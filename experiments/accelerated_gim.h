#ifndef BATTEN_EXPERIMENTS_ACCELERATED_GIM_H_
#define BATTEN_EXPERIMENTS_ACCELERATED_GIM_H_

#include "experiments/reproduction.h"

namespace batten {

/// "Accelerated Geometric Iteration Method" (Liu, Xin, Shu, Chen, Zhang, Zhao, 2016), run again:
/// its figures, its table and its claims.
Reproduction AcceleratedGim();

// Its experiments, one file each, accelerated_gim_NAME.cc.
Experiment AcceleratedGimFigure1();
Experiment AcceleratedGimFigure6();
Experiment AcceleratedGimOutlines();
Experiment AcceleratedGimThirtyIterations();
Experiment AcceleratedGimSize();
Experiment AcceleratedGimOrder();
Experiment AcceleratedGimSpectrum();
Experiment AcceleratedGimOneCall();
Experiment AcceleratedGimLargestResidual();
Experiment AcceleratedGimUnits();
Experiment AcceleratedGimStopRule();
Experiment AcceleratedGimWhenToIterate();

// What they share.
inline constexpr const char* kLspia = "lspia";
inline constexpr const char* kOptimalLspia = "lspia/step=optimal";
inline constexpr const char* kLbfgs = "lbfgs";
inline constexpr double kLoopSize = 10.0;  // of LoopProblem

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_ACCELERATED_GIM_H_
