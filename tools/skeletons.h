#ifndef BATTEN_TOOLS_SKELETONS_H_
#define BATTEN_TOOLS_SKELETONS_H_

namespace batten {

// What `batten new` writes. @NAME@ stands for the name, @CLASS@ for the class, @VERSION@ for ours.
extern const char kSolverSkeleton[];
extern const char kSolverBuild[];
extern const char kTermSkeleton[];
extern const char kTermBuild[];

}  // namespace batten

#endif  // BATTEN_TOOLS_SKELETONS_H_
