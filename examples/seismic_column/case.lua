-- An earthquake rises through 20 m of soil on rock: how much the soil amplifies it, beside the transfer function of a
-- layer on an elastic half-space. The record is synthetic, as measured on an outcrop of the rock.
--
--   ./cdem run examples/seismic_column/case.lua [--set zone=1.5]
local cdem = require "cdem"
local transfer = require "transfer"

local zone = cdem.parameter{ name = "zone", default = 1.0, range = {0.3, 5}, unit = "m", doc = "size of the elements" }
local after = cdem.parameter{ name = "after", default = 4.0, range = {0, 100}, unit = "s", doc = "run after the record" }

local H, depth = 20, 4 -- m, of the soil and of the rock below it that is modelled
local function ground(density, shear_speed, damping)
  local nu = 0.3
  return cdem.elastic{ youngs_modulus = 2 * (1 + nu) * density * shear_speed ^ 2, poissons_ratio = nu, density = density,
                       damping = damping }
end
local soil = ground(1900, 200, { fraction = 0.04, frequency = 4 }) -- of critical damping, at 4 Hz
local rock = ground(2300, 800)

local model = cdem.model{ bodies = {
  { name = "soil", shape = cdem.box{ size = {4, 2, H} }, material = soil, zone_size = zone },
  { name = "rock", shape = cdem.box{ size = {4, 2, depth}, origin = {0, 0, -depth} }, material = rock, zone_size = zone } },
  contacts = { {"soil", "rock", cdem.glued{ thickness = 0.1 }} } }

-- The outcrop's motion is twice the wave that rises in the rock: the free surface doubles it.
local outcrop = cdem.record{ file = "record.csv", value = "acceleration", unit = "g", to = "velocity", baseline = "straight" }
model:quiet{ on = "z-", velocity = {0.5, 0, 0}, amplitude = outcrop }
model:free_field{ on = {"x-", "x+"} }
model:fix{ on = {"y-", "y+"}, axes = "y" }
model:probe{ name = "surface", field = "velocity.x", at = {2, 1, H} }
model:probe{ name = "base", field = "velocity.x", at = {2, 1, 0} }
model:run{ duration = 3 }
model:picture{ file = "model.png", colour = "displacement.x", deformation = 200, title = "After 3 s",
               camera = { position = {20, -50, 22}, focal_point = {2, 1, 8}, up = {0, 0, 1}, view_angle = 28 } }
model:run{ duration = outcrop.duration + after - 3 }

local history = model:history()
local found = transfer.compare({ times = history.time, values = history.surface }, outcrop, H, soil, rock)
cdem.chart{ file = "amplification.png", x_label = "frequency (Hz)", y_label = "surface over outcrop",
            series = { { x = found.frequency, y = found.theory, name = "layer on half-space" },
                       { x = found.frequency, y = found.ratio, name = "cdem", style = "points" } } }
cdem.chart{ file = "motion.png", x_label = "time (s)", y_label = "velocity (m/s)",
            series = { { x = history.time, y = history.surface, name = "surface" },
                       { x = outcrop.times, y = outcrop.values, name = "outcrop" } } }
cdem.report{
  { name = "first_peak", value = found.peak, reference = transfer.peak(H, soil, rock), kind = "formula",
    source = "layer on elastic half-space (Kramer 1996, eq 7.28)", tolerance = 0.03 },
  { name = "first_peak_at", value = found.peak_at, unit = "Hz" },
  { name = "largest_deviation_to_10_Hz", value = found.worst, reference = 0, kind = "formula", source = "the same",
    tolerance_absolute = 0.06 },
  { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
    source = "energy is conserved", tolerance_absolute = 2e-3 } }
