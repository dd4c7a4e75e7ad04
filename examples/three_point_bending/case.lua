-- Petersson's notched concrete beam (1981) in three-point bending, cracked on three unstructured meshes beside the
-- fictitious-crack solution of the same beam.
--
--   ./cdem run examples/three_point_bending/case.lua [--set sizes=0.01,0.007] [--set slenderness=10]
local cdem = require "cdem"
local beam = require "beam"
local reference = require "reference"

local sizes = cdem.parameter{ name = "sizes", default = {0.02, 0.014, 0.01}, range = {0.003, 0.05}, unit = "m",
                              doc = "edges of the tetrahedra about the ligament, one run each" }
local coarse = cdem.parameter{ name = "coarse", default = 0.028, range = {0.005, 0.1}, unit = "m",
                               doc = "edges far from it" }
local depth = cdem.parameter{ name = "depth", default = 0.2, range = {0.02, 5}, unit = "m" }
local slenderness = cdem.parameter{ name = "slenderness", default = 4, type = "number", range = {2, 20},
                                    doc = "span over depth; 10 in the test" }
local energy = cdem.parameter{ name = "energy", default = 124, type = "number", range = {1, 1e5}, unit = "J/m2",
                               doc = "G_I" }
local deflection = cdem.parameter{ name = "deflection", default = 0.0, range = {0, 0.1}, unit = "m",
                                   doc = "at the end; 0: what leaves a fifth of the peak load in the reference" }
local periods = cdem.parameter{ name = "periods", default = 12, type = "number", range = {1, 1000},
                                doc = "of the beam's first mode that the bending takes" }
local damping = cdem.parameter{ name = "damping", default = 0.01, range = {0, 1}, doc = "of the first mode" }

beam.slenderness = slenderness

local given = { depth = depth, length = slenderness * depth, notch = beam.notch_ratio * depth, strip = 0,
                elements = 20, E = beam.youngs_modulus, nu = beam.poissons_ratio, strength = beam.strength,
                energy = energy }
local exact = reference.curve(given)
local function constant_strain_peak(size)
  local same = {}
  for key, value in pairs(given) do same[key] = value end
  same.elements, same.constant_strain = math.floor((1 - beam.notch_ratio) * depth / size + 0.5), true
  same.coarse = coarse
  return reference.peak(reference.curve(same)) * beam.width
end
local peak, peak_at = reference.peak(exact)
peak = peak * beam.width
local exact_load = {}
for i, load in ipairs(exact.load) do exact_load[i] = load * beam.width end

-- Straight between the points of a curve; beyond its end, the end.
local function at(x, y, where)
  for i = 2, #x do
    if x[i] >= where then return y[i - 1] + (y[i] - y[i - 1]) * (where - x[i - 1]) / (x[i] - x[i - 1]) end
  end
  return y[#y]
end
local function work(x, y, last)
  local sum = 0
  for i = 2, #x do
    if x[i] > last then break end
    sum = sum + (x[i] - x[i - 1]) * (y[i] + y[i - 1]) / 2
  end
  return sum
end
if deflection == 0 then
  for i = 1, #exact_load do
    if exact.deflection[i] > peak_at and exact_load[i] < peak / 5 and deflection == 0 then
      deflection = exact.deflection[i]
    end
  end
end

local ligament = (1 - beam.notch_ratio) * depth * beam.width
local colours = { {0.85, 0.33, 0.10}, {0.20, 0.55, 0.25}, {0.00, 0.27, 0.55}, {0.5, 0.2, 0.6} }
local curves = { { name = "fictitious crack", x = exact.deflection, y = exact_load, style = "dashed",
                   colour = {0, 0, 0} } }
local mouths = { { name = "fictitious crack", x = exact.mouth, y = exact_load, style = "dashed", colour = {0, 0, 0} } }
local ledger, figures, peaks = {}, {}, {}
local function add(figure) figures[#figures + 1] = figure end

for i, size in ipairs(sizes) do
  local began = cdem.elapsed()
  local samples = 0
  local finest = i == #sizes
  local model, curve = beam.bend{ depth = depth, size = size, coarse = coarse, thickness = beam.width,
                                  softening = "linear", energy = energy, deflection = deflection, periods = periods,
                                  damping = damping, samples = 40, safety = 0.8, watch = function(bent)
    samples = samples + 1
    if samples == 40 + 24 and finest then
      bent:picture{ file = "cracking.png", colour = "stress.xx", deformation = 200, size = {1600, 0},
                     range = {-beam.strength, beam.strength}, title = "Past the peak" }
    end
  end }
  local label = string.format("%g mm", size * 1e3)
  curves[#curves + 1] = { name = "cdem, " .. label, x = curve.deflection, y = curve.load, colour = colours[i] }
  mouths[#mouths + 1] = { name = "cdem, " .. label, x = curve.mouth, y = curve.load, colour = colours[i] }
  if finest then
    ledger = { { name = "elastic", x = curve.deflection, y = curve.elastic },
               { name = "crack", x = curve.deflection, y = curve.breaking },
               { name = "kinetic", x = curve.deflection, y = curve.kinetic } }
    model:picture{ file = "cracked.png", colour = "stress.xx", deformation = 100, size = {1600, 0},
                   range = {-beam.strength, beam.strength}, title = "Cracked beam" }
    model:save{ file = "beam.vtu" }
  end
  cdem.write_csv{ file = string.format("curve_%g.csv", size * 1e3), columns = {
    { name = "deflection_m", values = curve.deflection }, { name = "load_N", values = curve.load },
    { name = "mouth_m", values = curve.mouth }, { name = "elastic_J", values = curve.elastic },
    { name = "crack_J", values = curve.breaking }, { name = "kinetic_J", values = curve.kinetic } } }

  local largest, top = 0, beam.peak(curve)
  for k = 1, #curve.load do
    local off = math.abs(curve.load[k] - at(exact.deflection, exact_load, curve.deflection[k]))
    if off > largest then largest = off end
  end
  local kinetic_share = 0
  for k = 1, #curve.load do
    if curve.deflection[k] >= peak_at then
      kinetic_share = math.max(kinetic_share, curve.kinetic[k] / curve.elastic[k])
    end
  end
  peaks[#peaks + 1] = top
  local name = string.format("_%g_mm", size * 1e3)
  add{ name = "tetrahedra" .. name, value = model:counts().tets }
  add{ name = "peak_load_N" .. name, value = top, unit = "N", reference = peak, kind = "fe",
       source = "fictitious crack on the ligament, influence factors" }
  add{ name = "peak_load_over_reference" .. name, value = top / peak }
  add{ name = "peak_of_constant_strain_triangles_over_reference" .. name, value = constant_strain_peak(size) / peak,
       source = "the reference once more, of triangles of this size: what the element costs without any cracking" }
  add{ name = "largest_distance_of_the_curve_over_peak" .. name, value = largest / peak, reference = 0, kind = "fe",
       source = "the same, over all samples" }
  add{ name = "work_J" .. name, value = work(curve.deflection, curve.load, deflection), unit = "J",
       reference = work(exact.deflection, exact_load, deflection), kind = "fe",
       source = "the same, area under the curve up to the last deflection" }
  add{ name = "crack_energy_over_G_ligament" .. name, value = curve.breaking[#curve.breaking] / (energy * ligament) }
  add{ name = "largest_load_less_reactions_over_peak" .. name, value = curve.gap / peak, reference = 0,
       kind = "formula", source = "balance of forces; inertia is what is left" }
  add{ name = "largest_kinetic_over_elastic" .. name, value = kinetic_share,
       source = "from the peak on; quasi-static is far below 1" }
  add{ name = "energy_balance_error" .. name, value = curve.worst_balance, reference = 0, kind = "formula",
       source = "energy is conserved", tolerance_absolute = 1e-3 }
  add{ name = "wall_time_s" .. name, value = cdem.elapsed() - began, unit = "s" }
end

cdem.chart{ file = "load.png", title = "Load over deflection", series = curves, x_label = "deflection (m)",
            y_label = "load (N)", x_range = {0, deflection} }
cdem.chart{ file = "mouth.png", title = "Load over the opening of the notch's mouth", series = mouths,
            x_label = "opening (m)", y_label = "load (N)", x_range = {0, 1.05 * exact.mouth[#exact.mouth - 2]} }
cdem.chart{ file = "energy.png", title = "Energies of the finest mesh", series = ledger, x_label = "deflection (m)",
            y_label = "energy (J)" }

local low, high = math.huge, 0
for _, p in ipairs(peaks) do low, high = math.min(low, p), math.max(high, p) end
add{ name = "scatter_of_peaks", value = (high - low) / peak, reference = 0, kind = "fe", source = "mesh to mesh" }
cdem.report(figures)
