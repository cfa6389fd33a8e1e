#ifndef BATTEN_SOLVERS_OPTIONS_NOTE_H_
#define BATTEN_SOLVERS_OPTIONS_NOTE_H_

namespace batten {

/// Name of the note in which a solver over a library says what it reads back from that library, as
/// NAME/OPTION=VALUE/...: those of its options that the library answers for. It is held against
/// what was asked.
inline constexpr char kOptionsThatRan[] = "options that ran";

}  // namespace batten

#endif  // BATTEN_SOLVERS_OPTIONS_NOTE_H_
