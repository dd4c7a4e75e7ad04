// Benchmarks: each prints a table. What travels between machines are the ratios; absolute rates do not.
#pragma once

#include <vector>

namespace cdem {
struct Model;
}

namespace bench {

struct Settings {
  std::vector<int> sizes{100, 10000, 100000}; // blocks
  std::vector<int> tets{10000, 105000};       // of meshed cubes
  std::vector<int> bodies{1000, 10000};       // that touch
  int body_divisions = 1;                     // cells along an edge of one of them
  std::vector<int> heaps{100, 300, 1000};     // loose rigid blocks
  std::vector<int> units{};                   // that fall and settle
  std::vector<int> shatter{};                 // tetrahedra of cubes that shatter
  std::vector<int> discs{6000};               // tetrahedra of discs that split
  std::vector<int> prisms{5000};              // tetrahedra of prisms that are crushed
  std::vector<int> threads{1, 2};
  double seconds = 1; // of stepping per figure, at least
};

double copy_rate(int threads); // bytes moved per second, read and written, by a plain copy of a large array

void blocks(const Settings&); // star blocks with bonds: full step beside the bare element kernel
void meshes(const Settings&); // meshed cubes, continuous and bonded: full step beside the bare kernels

cdem::Model meshed_cube(int tets, bool bonded); // of a unit's size, cells jittered
void among_ranks(const Settings&);              // meshed cubes by several processes; all of them call it

void contacts(const Settings&); // cubes that touch: search and full step
void heaps(const Settings&); // rigid blocks that part and strike each other: cost of a step over their number
void piles(const Settings&); // armour units that settle on a slope
void shatter(const Settings&);  // a bonded cube that breaks while it runs
void cracking(const Settings&); // discs and prisms that crack between plates

} // namespace bench
