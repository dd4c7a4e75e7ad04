-- A concrete prism crushed between platens, on three unstructured meshes: its peak beside Mohr and Coulomb's strength, and
-- on beyond it to the fragments.
--
--   ./cdem run examples/compression/case.lua [--set ends=held] [--set sizes=0.014] [--set film=true]
local cdem = require "cdem"

local sizes = cdem.parameter{ name = "sizes", default = {0.03, 0.022, 0.017}, range = {0.003, 0.05}, unit = "m",
                              doc = "edges of the tetrahedra, one run each" }
local ends = cdem.parameter{ name = "ends", default = "smooth", choices = {"smooth", "held"},
                             doc = "smooth: they slide on the platens; held: they stick to them" }
local shortening = cdem.parameter{ name = "shortening", default = 1.6e-3, range = {1e-4, 0.1}, doc = "over the height" }
local speed = cdem.parameter{ name = "speed", default = 0.2, range = {1e-3, 10}, unit = "m/s", doc = "of the upper platen" }
local shear_energy = cdem.parameter{ name = "shear_energy", default = 200, type = "number", range = {1, 1e6},
                                     unit = "J/m2", doc = "G_II" }
local pictures = cdem.parameter{ name = "pictures", default = true, doc = "draw them" }
local film = cdem.parameter{ name = "film", default = false, doc = "of the finest" }

local width, height = 0.1, 0.2 -- m
local cohesion, phi = 7.5e6, 37 -- Pa, deg: concrete of 30 MPa
local strength = 2 * cohesion * math.tan(math.rad(45 + phi / 2))
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2400 }
local joint = cdem.mohr_coulomb{ cohesion = cohesion, friction_angle = phi, tensile_strength = 3e6, softening = "linear",
                                 fracture_energy_1 = 100, fracture_energy_2 = shear_energy }

-- Leads the upper platen down; the model and its curve: lists strain, stress (Pa, mean of both ends over each sample) and
-- energies (J), and balance, the largest error of the ledger.
local function crush(size, draw)
  local mesh = cdem.solid.box{ size = {width, width, height} }:mesh{ size = size }
  local model = cdem.model{ bodies = { { name = "prism", shape = mesh, material = concrete, joint = joint,
                                         bonds = "cohesive" } },
                            contacts = { { "prism", "prism", cdem.coulomb{ friction_angle = phi } } } }
  local axes = ends == "held" and "xyz" or "z"
  model:fix{ on = "z-", axes = axes }
  local curve = { strain = {0}, stress = {0}, breaking = {0}, friction = {0}, kinetic = {0}, elastic = {0}, balance = 0 }
  local sum, n, down, frames = 0, 0, 0, {}
  local samples, ramp = 64, 6 -- a smooth start: the velocity grows over the first samples
  local time = shortening * height / speed / (samples - ramp / 2)
  for i = 1, samples do
    local v = speed * math.min(1, (i - 0.5) / ramp)
    model:fix{ on = "z+", axes = axes, velocity = {0, 0, -v} }
    model:run{ duration = time, every = 2, callback = function()
      sum, n = sum + (model:reaction("z-")[3] - model:reaction("z+")[3]) / 2, n + 1
    end }
    local e, k = model:energy(), i + 1
    curve.strain[k], curve.stress[k] = (down + v * time / 2) / height, sum / n / width ^ 2
    curve.breaking[k], curve.friction[k] = e.breaking, e.friction
    curve.kinetic[k], curve.elastic[k] = e.kinetic, e.elastic + e.springs
    curve.balance = math.max(curve.balance, e.balance_error)
    sum, n, down = 0, 0, down + v * time
    if draw and (film or i % 16 == 0) then
      frames[#frames + 1] = string.format("crushed_%02d.png", i)
      model:picture{ file = frames[#frames], view = "iso", up = "z", colour = "displacement.x", deformation = 20,
                     range = {-2e-4, 2e-4}, broken_bonds = false,
                     title = string.format("Strain %.2f \u{2030}", 1e3 * down / height) }
    end
  end
  if draw and film then cdem.film{ file = "crushed.ogv", frames = frames } end
  return model, curve
end

local colours = { {0.85, 0.33, 0.10}, {0.20, 0.55, 0.25}, {0.00, 0.27, 0.55} }
local figures, lines, finest = {}, {}, nil
for i, size in ipairs(sizes) do
  local began = cdem.elapsed()
  local model, curve = crush(size, pictures and i == #sizes)
  local at = 1
  for k, stress in ipairs(curve.stress) do
    if stress > curve.stress[at] then at = k end
  end
  local label, counts = string.format("%g_mm", size * 1e3), model:counts()
  lines[i] = { name = label:gsub("_", " ") .. ", " .. counts.tets .. " tetrahedra", x = curve.strain, y = curve.stress,
               colour = colours[(i - 1) % 3 + 1] }
  finest = curve
  local last = #curve.strain
  local columns = {}
  for _, name in ipairs{ "strain", "stress", "elastic", "breaking", "friction", "kinetic" } do
    columns[#columns + 1] = { name = name, values = curve[name] }
  end
  cdem.write_csv{ file = "curve_" .. label .. ".csv", columns = columns }
  local function add(name, value, more)
    local figure = more or {}
    figure.name, figure.value = name .. "_" .. label, value
    figures[#figures + 1] = figure
  end
  add("tetrahedra", counts.tets)
  add("peak_over_mohr_coulomb", curve.stress[at] / strength,
      { reference = 1, kind = "formula", tolerance = 0.1, source = "2 c tan(45 + phi / 2)" })
  add("stress_at_the_end_over_peak", curve.stress[last] / curve.stress[at])
  add("least_stress_after_peak_over_peak", math.min(table.unpack(curve.stress, at)) / curve.stress[at])
  add("kinetic_over_elastic_at_peak", curve.kinetic[at] / math.max(curve.elastic[at], 1e-12))
  add("crack_energy_over_G_II_section", curve.breaking[last] / (shear_energy * width ^ 2))
  add("friction_over_crack_energy", curve.friction[last] / math.max(curve.breaking[last], 1e-12))
  add("broken_in_tension", counts.broken_tension)
  add("broken_in_shear", counts.broken_shear)
  add("fragments", #model:fragments())
  add("energy_balance_error", curve.balance,
      { reference = 0, kind = "formula", source = "energy is conserved", tolerance_absolute = 0.01 })
  add("wall_time_s", cdem.elapsed() - began, { unit = "s" })
  if pictures and i == #sizes then model:save{ file = "crushed.vtu" } end
end
local last = sizes[#sizes] and finest.strain[#finest.strain]
lines[#lines + 1] = { name = "Mohr and Coulomb", x = {0, last}, y = {strength, strength}, style = "dashed", colour = {0, 0, 0} }
cdem.chart{ file = "stress.png", title = "Prism in compression, ends " .. ends, x_label = "strain", y_label = "stress (Pa)",
            y_range = {0, 1.6 * strength}, legend = "top_left", series = lines }
cdem.chart{ file = "energy.png", title = "Energies, finest mesh", x_label = "strain", y_label = "energy (J)", series = {
  { name = "elastic", x = finest.strain, y = finest.elastic }, { name = "cracks", x = finest.strain, y = finest.breaking },
  { name = "friction", x = finest.strain, y = finest.friction }, { name = "kinetic", x = finest.strain, y = finest.kinetic } } }
cdem.report(figures)
