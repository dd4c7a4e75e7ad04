-- The transfer function of a damped layer on an elastic half-space: motion of the surface over that of an outcrop.
--
--   F = 1 / (cos k H + i a sin k H),   k = w sqrt(rho* / G*),   a = sqrt(rho* G*) / sqrt(rho_r G_r)
--
-- with Rayleigh's damping of the layer, G* = G (1 + i w beta), rho* = rho (1 - i alpha / w).
local transfer = {}

local function mul(a, b) return { a[1] * b[1] - a[2] * b[2], a[1] * b[2] + a[2] * b[1] } end
local function div(a, b)
  local d = b[1] ^ 2 + b[2] ^ 2
  return { (a[1] * b[1] + a[2] * b[2]) / d, (a[2] * b[1] - a[1] * b[2]) / d }
end
local function root(a)
  local r, angle = math.sqrt(math.sqrt(a[1] ^ 2 + a[2] ^ 2)), 0.5 * math.atan(a[2], a[1])
  return { r * math.cos(angle), r * math.sin(angle) }
end
local function cosh(x) return 0.5 * (math.exp(x) + math.exp(-x)) end
local function sinh(x) return 0.5 * (math.exp(x) - math.exp(-x)) end

function transfer.amplification(f, height, layer, rock)
  local w = 2 * math.pi * f
  local modulus = { layer.shear_modulus, layer.shear_modulus * w * layer.stiffness_damping }
  local density = { layer.density, -layer.viscosity / w }
  local k = root(div(density, modulus))
  local x, y = w * height * k[1], w * height * k[2]
  local cosine, sine = { math.cos(x) * cosh(y), -math.sin(x) * sinh(y) }, { math.sin(x) * cosh(y), math.cos(x) * sinh(y) }
  local a = root(mul(density, modulus))
  local scale = math.sqrt(rock.density * rock.shear_modulus)
  local second = mul({ -a[2] / scale, a[1] / scale }, sine) -- i a sin
  return 1 / math.sqrt((cosine[1] + second[1]) ^ 2 + (cosine[2] + second[2]) ^ 2)
end

-- The largest below 4 Hz.
function transfer.peak(height, layer, rock)
  local most = 0
  for i = 1, 400 do most = math.max(most, transfer.amplification(0.01 * i, height, layer, rock)) end
  return most
end

-- Fourier amplitude of a motion at f.
local function spectrum(motion, f)
  local c, s, times, values = 0, 0, motion.times, motion.values
  for i = 2, #times do
    local dt, w = times[i] - times[i - 1], 2 * math.pi * f
    c = c + dt * values[i] * math.cos(w * times[i])
    s = s + dt * values[i] * math.sin(w * times[i])
  end
  return math.sqrt(c * c + s * s)
end

-- Surface over outcrop beside the transfer function from 0.6 to 10 Hz, and the largest ratio below 4 Hz.
function transfer.compare(surface, outcrop, height, layer, rock)
  local r = { frequency = {}, ratio = {}, theory = {}, worst = 0, peak = 0, peak_at = 0 }
  for f = 0.6, 10, 0.1 do
    local i = #r.frequency + 1
    r.frequency[i], r.theory[i] = f, transfer.amplification(f, height, layer, rock)
    r.ratio[i] = spectrum(surface, f) / spectrum(outcrop, f)
    r.worst = math.max(r.worst, math.abs(r.ratio[i] / r.theory[i] - 1))
    if f < 4 and r.ratio[i] > r.peak then r.peak, r.peak_at = r.ratio[i], f end
  end
  return r
end

return transfer
