#include <cstdio>

#include "splines/bspline_basis.h"

int main() {
  std::puts("Batten is installed.");
  return 0;
}
