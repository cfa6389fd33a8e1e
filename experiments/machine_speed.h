#ifndef BATTEN_EXPERIMENTS_MACHINE_SPEED_H_
#define BATTEN_EXPERIMENTS_MACHINE_SPEED_H_

namespace batten {

/// Seconds of a fixed piece of arithmetic that no part of Batten has a share in: what two sessions'
/// seconds can be measured by. Half of it waits for divisions, one after the other, half streams
/// through 32 KiB. Median of several; takes about 2 ms.
double ReferenceSeconds();

}  // namespace batten

#endif  // BATTEN_EXPERIMENTS_MACHINE_SPEED_H_
