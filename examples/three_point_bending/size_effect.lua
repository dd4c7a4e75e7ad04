-- Three notched beams of one shape: nominal strength over size, between the strength of a plastic ligament and that of
-- linear elastic fracture mechanics, with Bazant's size-effect law (1984) through the three.
--
--   ./cdem run examples/three_point_bending/size_effect.lua [--set depths=0.05,0.1,0.2]
local cdem = require "cdem"
local beam = require "beam"
local reference = require "reference"

local depths = cdem.parameter{ name = "depths", default = {0.05, 0.2, 0.8}, range = {0.01, 10}, unit = "m",
                               doc = "two or more" }
local elements = cdem.parameter{ name = "elements", default = 8, range = {3, 100},
                                 doc = "tetrahedra through the ligament, of every size" }
local periods = cdem.parameter{ name = "periods", default = 6, type = "number", range = {1, 1000},
                                doc = "of the first mode that the bending up to 1.6 times the peak's deflection takes" }
local damping = cdem.parameter{ name = "damping", default = 0.01, range = {0, 1}, doc = "of the first mode" }

local ft, E, G = beam.strength, beam.youngs_modulus, beam.fracture_energy
local factors, depth_of_factors
local function exact(depth)
  local given = { depth = depth, length = beam.slenderness * depth, notch = beam.notch_ratio * depth, strip = 0,
                  elements = 20, E = E, nu = beam.poissons_ratio, strength = ft, energy = G }
  if not factors then factors, depth_of_factors = reference.influence(given), depth end
  local load, at = reference.peak(reference.curve(given, reference.scaled(factors, depth / depth_of_factors)))
  return load / depth, at
end

-- Ligament plastic in tension, a hinge at its top: P span / 4 = ft b (d - a)^2 / 2.
local plastic = 2 * ft * (1 - beam.notch_ratio) ^ 2 / beam.slenderness
-- K_I = P span / (b d^1.5) f(a/d) = sqrt(E G), f of ASTM E399 for a span of 4 d.
local function brittle(depth)
  local a = beam.notch_ratio
  local f = 3 * math.sqrt(a) * (1.99 - a * (1 - a) * (2.15 - 3.93 * a + 2.7 * a * a)) /
            (2 * (1 + 2 * a) * (1 - a) ^ 1.5)
  return math.sqrt(E * G / depth) / (beam.slenderness * f)
end

local figures, nominal = {}, {}
for i, depth in ipairs(depths) do
  local began = cdem.elapsed()
  local wanted, at = exact(depth)
  local width = depth / 4
  local model, curve = beam.bend{ depth = depth, size = (1 - beam.notch_ratio) * depth / elements,
                                  coarse = 0.14 * depth, thickness = width, softening = "linear", energy = G,
                                  deflection = 1.6 * at, periods = periods, damping = damping, samples = 40,
                                  stop_below = 0.85, safety = 0.8 }
  nominal[i] = beam.peak(curve) * width / beam.width / (width * depth)
  local name = string.format("_d_%g_mm", depth * 1e3)
  figures[#figures + 1] = { name = "nominal_strength_Pa" .. name, value = nominal[i], unit = "Pa", reference = wanted,
                            kind = "fe", source = "fictitious crack on the ligament" }
  figures[#figures + 1] = { name = "over_fictitious_crack" .. name, value = nominal[i] / wanted }
  figures[#figures + 1] = { name = "over_LEFM" .. name, value = nominal[i] / brittle(depth) }
  figures[#figures + 1] = { name = "over_plastic_ligament" .. name, value = nominal[i] / plastic }
  figures[#figures + 1] = { name = "tetrahedra" .. name, value = model:counts().tets }
  figures[#figures + 1] = { name = "wall_time_s" .. name, value = cdem.elapsed() - began, unit = "s" }
end

-- sigma_N = B ft / sqrt(1 + d / d0): 1 / sigma_N^2 is a straight line in d.
local function fit(x, y)
  local n, sx, sy, sxx, sxy = #x, 0, 0, 0, 0
  for i = 1, n do
    local v = 1 / y[i] ^ 2
    sx, sy, sxx, sxy = sx + x[i], sy + v, sxx + x[i] ^ 2, sxy + x[i] * v
  end
  local slope = (n * sxy - sx * sy) / (n * sxx - sx * sx)
  local start = (sy - slope * sx) / n
  return 1 / math.sqrt(start), start / slope -- B ft, d0
end
local wanted = {}
for i, depth in ipairs(depths) do wanted[i] = exact(depth) end
local small, d0 = fit(depths, nominal)
local wanted_small, wanted_d0 = fit(depths, wanted)
figures[#figures + 1] = { name = "bazant_B", value = small / ft, reference = wanted_small / ft, kind = "fe",
                          source = "the same fit to the fictitious crack" }
figures[#figures + 1] = { name = "bazant_d0_m", value = d0, unit = "m", reference = wanted_d0, kind = "fe",
                          source = "the same fit to the fictitious crack" }

local d, law, lefm, strength, exact_d, exact_s = {}, {}, {}, {}, {}, {}
local first, last = depths[1] / 2, depths[#depths] * 2
for i = 0, 40 do
  d[#d + 1] = first * (last / first) ^ (i / 40)
  law[#law + 1] = small / math.sqrt(1 + d[#d] / d0)
  lefm[#lefm + 1], strength[#strength + 1] = brittle(d[#d]), plastic
  if i % 5 == 0 then
    exact_d[#exact_d + 1], exact_s[#exact_s + 1] = d[#d], exact(d[#d])
  end
end
cdem.chart{ file = "size_effect.png", title = "Nominal strength P / (b d) over size", log_x = true, log_y = true,
            x_label = "depth (m)", y_label = "nominal strength (Pa)", legend = "top_right", series = {
  { name = "cdem", x = depths, y = nominal, style = "points", colour = {0.85, 0.33, 0.10} },
  { name = "Bazant's law through them", x = d, y = law, colour = {0.85, 0.33, 0.10} },
  { name = "fictitious crack", x = exact_d, y = exact_s, style = "dashed", colour = {0, 0, 0} },
  { name = "plastic ligament", x = d, y = strength, colour = {0.5, 0.5, 0.5} },
  { name = "linear elastic fracture mechanics", x = d, y = lefm, colour = {0.00, 0.27, 0.55} } } }
cdem.report(figures)
