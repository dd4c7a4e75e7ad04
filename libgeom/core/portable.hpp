// exp, log, sin, cos, tan, atan2 and acos with the same bits on every processor.
//
// The C library selects a version for the processor, and versions with and without fused operations differ in the last
// digit. The functions here use only additions, multiplications, divisions and square roots, which every processor
// rounds in the same way (IEEE 754). All code that affects the mechanics uses them. Up to 10 rad they are right to 2
// units of the last place, the tangent to 4.
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
