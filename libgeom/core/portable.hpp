// exp, log, sin, cos, tan, atan2 and acos with the same bits on every processor.
//
// The C library picks a version of its own by what the processor has, and versions with and without fused operations
// differ in the last digit. These use additions, multiplications, divisions and square roots alone, which every
// processor rounds alike (IEEE 754). Whatever moves a body or decides about mechanics takes them. Up to 10 rad they are
// right to 2 units of the last place, the tangent to 4.
#pragma once

namespace geom::portable {

double exp(double);
double log(double);       // of what is > 0
double sin(double angle); // rad
double cos(double angle); // rad
double tan(double angle); // rad
double atan2(double y, double x);
double acos(double);

} // namespace geom::portable
