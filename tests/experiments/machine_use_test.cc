#include "experiments/machine_use.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>

#include "tests/problems/scratch_folder.h"

namespace batten {
namespace {

TEST(MachineUse, SeesOthersForAsLongAsTheyAreThere) {
  const ScratchFolder folder;
  const std::string path = folder.path() / "lock";
  const MachineUse first(path);
  EXPECT_FALSE(first.OthersMeasure());
  {
    const MachineUse second(path);
    const MachineUse third(path);
    EXPECT_TRUE(first.OthersMeasure());
    EXPECT_TRUE(second.OthersMeasure());
    EXPECT_TRUE(third.OthersMeasure());
  }
  EXPECT_FALSE(first.OthersMeasure());
}

TEST(MachineUse, ForkedProcessesAreNoOthersButHoldOn) {
  const ScratchFolder folder;
  const std::string path = folder.path() / "lock";
  auto use = std::make_unique<MachineUse>(path);
  int to_child[2];
  int from_child[2];
  ASSERT_EQ(pipe(to_child), 0);
  ASSERT_EQ(pipe(from_child), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    close(to_child[1]);
    char answer = use->OthersMeasure() ? 'y' : 'n';
    (void)!write(from_child[1], &answer, 1);
    (void)!read(to_child[0], &answer, 1);  // until its parent lets go
    _exit(0);
  }
  char answer = '?';
  ASSERT_EQ(read(from_child[0], &answer, 1), 1);
  EXPECT_EQ(answer, 'n');
  EXPECT_FALSE(use->OthersMeasure());
  use.reset();  // as a killed program does, whose child still runs
  const MachineUse next(path);
  EXPECT_TRUE(next.OthersMeasure());
  close(to_child[1]);
  waitpid(child, nullptr, 0);
  EXPECT_FALSE(next.OthersMeasure());
  for (const int file : {to_child[0], from_child[0], from_child[1]}) close(file);
}

TEST(MachineUse, IsSharedWithWhoMayOnlyRead) {
  const ScratchFolder folder;
  const std::string path = folder.path() / "lock";
  const MachineUse first(path);
  ASSERT_EQ(chmod(path.c_str(), 0444), 0);
  const MachineUse second(path);
  EXPECT_TRUE(first.OthersMeasure());
  EXPECT_TRUE(second.OthersMeasure());
}

TEST(MachineUse, SeesNobodyWhereThereIsNoFile) {
  const ScratchFolder folder;
  const MachineUse first(folder.path() / "no/such/lock");
  const MachineUse second(folder.path() / "no/such/lock");
  EXPECT_FALSE(first.OthersMeasure());
}

}  // namespace
}  // namespace batten
