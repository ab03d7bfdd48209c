// The course's util/random_util.h, found before it: what it draws are the bench's numbers. Its own engine has one state a
// source file and always the same seed, so runs could not be told apart, nor depths compared along one path.
#pragma once

#define random_uniform random_uniform_of_the_course
#define coin_flip coin_flip_of_the_course
#include_next "util/random_util.h"
#undef random_uniform
#undef coin_flip

namespace CGL {

double number_of_the_bench(); // in [0, 1)

inline double random_uniform() {
   const double number = number_of_the_bench();
   return number < 1e-7 ? 1e-7 : number > 0.99999999 ? 0.99999999 : number;
}

inline bool coin_flip(double p) { return random_uniform() < p; }

} // namespace CGL
