#ifndef BATTEN_TOOLS_SKELETONS_H_
#define BATTEN_TOOLS_SKELETONS_H_

namespace batten {

// What `batten new` writes. @NAME@ stands for the name, @CLASS@ for the class, @VERSION@ for ours.
// The CMake file is kBuild with the test of its kind behind.
extern const char kBuild[];
extern const char kSolverSkeleton[];
extern const char kSolverTest[];
extern const char kTermSkeleton[];
extern const char kTermTest[];

}  // namespace batten

#endif  // BATTEN_TOOLS_SKELETONS_H_
