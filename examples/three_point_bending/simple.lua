-- A notched concrete beam in three-point bending, in one short script: the load grows, a crack runs up from the notch, the
-- load falls. case.lua compares the same test with a reference solution.
--
--   ./cdem run examples/three_point_bending/simple.lua [--set size=0.012] [--set fracture_energy=60]
local cdem = require "cdem"

local size = cdem.parameter{ name = "size", default = 0.014, range = {0.004, 0.05}, unit = "m",
                              doc = "edges of the tetrahedra at the notch" }
local energy = cdem.parameter{ name = "fracture_energy", default = 124.0, range = {10, 1e4}, unit = "J/m2", doc = "G_I" }
local deflection = cdem.parameter{ name = "deflection", default = 0.3e-3, range = {1e-5, 5e-3}, unit = "m", doc = "at the end" }
local duration = cdem.parameter{ name = "duration", default = 0.02, range = {1e-3, 1}, unit = "s", doc = "of the bending" }

-- 0.8 x 0.2 x 0.05 m, notched over half its depth. The notch is a wedge: its tip is one line of nodes.
local span, depth, width = 0.8, 0.2, 0.05
local wedge = cdem.convex_hull{ points = { {-0.01, -0.01, -1}, {0.01, -0.01, -1}, {0, depth / 2, -1},
                                           {-0.01, -0.01, 1}, {0.01, -0.01, 1}, {0, depth / 2, 1} } }
local beam = cdem.solid.cut{ solid = cdem.solid.box{ size = {span, depth, width}, origin = {-span / 2, 0, 0} },
                             tools = { wedge:solid() } }
local mesh = beam:mesh{ size = 0.03, refine = { { box = { min = {-0.02, depth / 2, 0}, max = {0.02, depth, width} },
                                                  size = size } } }

-- Concrete whose strength falls linearly while a crack opens.
local strength = 3.33e6 -- Pa
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400, viscosity = 4e5 }
local crack = cdem.mohr_coulomb{ cohesion = 3 * strength, friction_angle = 30, tensile_strength = strength, softening = "linear",
                                 fracture_energy_1 = energy, fracture_energy_2 = 10 * energy }
local model = cdem.model{ bodies = { { name = "beam", shape = mesh, material = concrete, joint = crack } } }

-- Supported at the lower ends, pressed down at mid-span. The velocity grows over the first fifth of the time.
local function strip(x, y) return cdem.select.box{ min = {x - 0.012, y - 1e-6, -1}, max = {x + 0.012, y + 1e-6, 1} } end
model:fix{ on = strip(-span / 2, 0), axes = "xyz" }
model:fix{ on = strip(span / 2, 0), axes = "yz" }
model:select{ name = "load", on = strip(0, depth) }
local velocity = deflection / (0.9 * duration)
model:fix{ on = "load", axes = "y", velocity = {0, -velocity, 0}, amplitude = { {0, 0}, {0.2 * duration, 1} } }

-- Run, and sample the load 60 times; it is the mean over the steps since the last sample, which takes out the ringing.
local curve = { deflection = {0}, load = {0} }
local sum, count, samples = 0, 0, 60
model:record_cracks{}
for _ = 1, samples do
  model:run{ duration = duration / samples, every = 20, callback = function()
    sum, count = sum - model:reaction("load")[2], count + 1
  end }
  curve.deflection[#curve.deflection + 1] = -model:mean("displacement.y", "load")
  curve.load[#curve.load + 1] = sum / count
  sum, count = 0, 0
end

model:picture{ file = "cracked.png", colour = "stress.xx", deformation = 150, range = {-strength, strength},
               title = "Horizontal stress after the peak", size = {1600, 0} }
cdem.chart{ file = "load.png", title = "Load over deflection", x_label = "deflection (m)", y_label = "load (N)",
            series = { { name = "cdem", x = curve.deflection, y = curve.load } } }
model:save{ file = "beam.vtu" }
local cracks = model:cracks()
cdem.report{ { name = "peak_load", value = math.max(table.unpack(curve.load)), unit = "N", kind = "fe", tolerance = 0.15,
               reference = energy == 124 and 2184 or nil, source = "fictitious crack, reference.lua" },
             { name = "last_load", value = curve.load[#curve.load], unit = "N" },
             { name = "crack_energy", value = cracks.energy, unit = "J" },
             { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
               source = "energy is conserved", tolerance_absolute = 0.01 },
             { name = "wall_time_s", value = cdem.elapsed(), unit = "s" } }
