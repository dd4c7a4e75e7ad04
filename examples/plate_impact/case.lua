-- A notched plate of glass under sudden tension: the crack runs, stays slower than Rayleigh's waves, and branches.
-- The branching benchmark of Song, Wang and Belytschko (2008), 100 x 40 mm under 1 MPa.
--
--   ./cdem run examples/plate_impact/case.lua [--set size=0.7e-3] [--set irregular=true]
local cdem = require "cdem"
local crack = require "crack"

local size = cdem.parameter{ name = "size", default = 1e-3, range = {2e-4, 5e-3}, unit = "m",
                             doc = "edges of the tetrahedra" }
local stress = cdem.parameter{ name = "stress", default = 1e6, type = "number", range = {1e4, 1e8}, unit = "Pa",
                               doc = "sudden and constant on the long sides" }
local energy = cdem.parameter{ name = "energy", default = 3, type = "number", range = {0.1, 1e4}, unit = "J/m2", doc = "G_I" }
local irregular = cdem.parameter{ name = "irregular", default = false,
                                  doc = "a mesh without rows, of twice this size behind the notch's tip" }
local pictures = cdem.parameter{ name = "pictures", default = true, doc = "draw them" }
local duration = cdem.parameter{ name = "duration", default = 66e-6, range = {1e-6, 1e-3}, unit = "s" }

local length, height, notch = 0.1, 0.04, 0.05 -- m
local strength = 3.08e6
local glass = cdem.elastic{ youngs_modulus = 32e9, poissons_ratio = 0.2, density = 2450 }
local joint = cdem.mohr_coulomb{ cohesion = 3 * strength, friction_angle = 30, tensile_strength = strength,
                                 softening = "linear", fracture_energy_1 = energy, fracture_energy_2 = 10 * energy }
local mesh = crack.plate(length, height, notch, size, irregular)
local model = cdem.model{ bodies = { { name = "plate", shape = mesh, material = glass, joint = joint,
                                       bonds = "cohesive" } } }
model:fix{ on = "all", axes = "z" } -- plane strain
model:traction{ on = "y+", stress = {0, stress, 0} }
model:traction{ on = "y-", stress = {0, -stress, 0} }

local samples, worst = 33, 0
for i = 1, samples do
  model:run{ duration = duration / samples }
  local e = model:energy()
  worst = math.max(worst, math.abs(e.total - e.external))
  if pictures and i % 11 == 0 then
    model:picture{ file = string.format("at_%.0f_us.png", model.time * 1e6), colour = "principal_stress.1",
                   deformation = 50, range = {0, strength}, size = {1600, 0}, edges = false,
                   title = string.format("%.1f \u{b5}s after the load", model.time * 1e6) }
  end
end
if pictures then
  mesh:picture{ file = "mesh.png", edges = "mesh", size = {1600, 0} }
  model:picture{ file = "crack.png", opacity = 0.3, edges = false, size = {1600, 0}, title = "Broken faces" }
  model:save{ file = "plate.vtu" }
end

local shear_speed = math.sqrt(glass.shear_modulus / glass.density)
local rayleigh = crack.rayleigh_speed(shear_speed, glass.poissons_ratio)
local breaks = model:breaks()
local path = crack.path(breaks, notch, duration, samples)
local branch = crack.branch(breaks, notch, length, 2.5e-3)
local share, limit, sixty, top = {}, {}, {}, 0
for i, v in ipairs(path.speed) do
  share[i], limit[i], sixty[i] = v / rayleigh, 1, 0.6
  top = math.max(top, v)
end
cdem.chart{ file = "speed.png", title = "Speed of the crack tip", x_label = "time (s)", y_label = "speed over Rayleigh's",
            y_range = {0, 1.4}, legend = "top_left", series = {
  { name = "cdem", x = path.time, y = share, style = "both", colour = {0.85, 0.33, 0.10} },
  { name = "Rayleigh", x = path.time, y = limit, style = "dashed", colour = {0, 0, 0} },
  { name = "60 %", x = path.time, y = sixty, style = "dashed", colour = {0.5, 0.5, 0.5} } } }
cdem.write_csv{ file = "tip.csv", columns = {
  { name = "time_s", values = path.time }, { name = "tip_m", values = path.tip },
  { name = "speed_m_per_s", values = path.speed } } }
local area = 0
for _, b in ipairs(breaks) do area = area + b.area end
local spent = model:energy().breaking
cdem.report{
  { name = "rayleigh_speed_m_per_s", value = rayleigh, unit = "m/s", reference = 2125, kind = "paper", tolerance = 1e-3,
    source = "Borden and others 2012, of the same benchmark" },
  { name = "starts_at_s", value = path.starts, unit = "s" },
  { name = "largest_speed_over_rayleigh", value = top / rayleigh, reference = 0.6, kind = "trial",
    source = "published solutions of the benchmark stay near or below it" },
  { name = "branches_at_x_m", value = branch and branch.x, unit = "m" },
  { name = "branches_at_s", value = branch and branch.time, unit = "s" },
  { name = "broken_area_over_thickness_m", value = area / crack.thickness(size), unit = "m" },
  { name = "crack_energy_over_G_area", value = spent > 0 and spent / (energy * area) or nil },
  { name = "energy_balance_error", value = worst / model:energy().external_peak, reference = 0, kind = "formula",
    source = "energy is conserved", tolerance_absolute = 1e-3 },
  { name = "tetrahedra", value = mesh.tets },
  { name = "steps", value = model.steps },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
