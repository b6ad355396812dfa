"""A rod that turns over by SciPy, and its scene: no line shared with the library."""

import math

from scipy import integrate, optimize, special

import frictionjax as fx

STIFFNESS, LENGTH, HEIGHT, REST, BENDING, OMEGA = 1.0, 2**0.5, 1.0, 0.3, 0.15, 0.5
EPS, GAMMA, SUPPORT = 0.08, 0.75, 0.8


def scipy_scene(load=None, bending=BENDING, support=SUPPORT, duration=5.0):
    load = fx.loads.Sine(1.9, 4.0) if load is None else load
    return fx.Scene(
        fx.profiles.Sine(OMEGA),
        fx.bristles.AngularSpring(STIFFNESS, LENGTH, HEIGHT, REST),
        fx.supports.Spring(support),
        load,
        duration,
        effects=(fx.effects.NapFlip(bending),),
    )


class Independent:
    """The same system in u and tip p, with SciPy: modes, events, elastica."""

    reach = math.sqrt(LENGTH**2 - HEIGHT**2)
    critical = math.pi**2 * BENDING / LENGTH**2
    drag = EPS**GAMMA

    def __init__(self, guard=1.0):
        self.guard = guard  # of the critical load: it turns over there

    def height(self, p):
        phase = 2 * math.pi * p / EPS
        return EPS * OMEGA / (2 * math.pi) * math.sin(phase), OMEGA * math.cos(phase)

    def straight(self, p, mode):
        """Where the root is, du/dp, force of the rod on the root, and compression."""
        w, slope = self.height(p)
        across = math.sqrt(LENGTH**2 - (HEIGHT - w) ** 2)
        angle = mode * math.atan2(across, HEIGHT - w)
        torque = STIFFNESS * (angle - REST)
        ahead = mode * across
        # d(ahead)/dp from ahead^2 + (HEIGHT - w)^2 = L^2
        rate = (HEIGHT - w) * slope / ahead
        # d(angle)/dp = (1/(HEIGHT - w)) cos^2 (rate + tan slope)
        turned = (rate * (HEIGHT - w) + ahead * slope) / LENGTH**2
        force = torque * turned / (1 + rate)
        # The contact force has the direction (-w', 1); along x it is -force.
        normal = force / slope if abs(slope) > 1e-12 else torque / ahead
        pressed = normal * math.cos(angle) - force * math.sin(angle)
        return p + ahead, 1 + rate, force, pressed

    def bent(self, x, low):
        """Force of the rod in between; low: the root's height above the tip."""
        chord = math.hypot(x, low)

        def short(m):
            return 2 * special.ellipe(m) / special.ellipk(m) - 1 - chord / LENGTH

        m = optimize.brentq(short, -1e-2, 1 - 1e-12, xtol=1e-15)
        thrust = self.critical * (2 * special.ellipk(m) / math.pi) ** 2
        twist = STIFFNESS * (math.atan2(x, low) - REST)
        return (twist * low / chord - thrust * x) / chord

    def pull(self, t, u):
        load = 1.9 * math.sin(2 * math.pi * t / 4.0)
        return load - SUPPORT * (u - self.reach)

    def run(self, until):
        t, mode = 0.0, 1
        p = optimize.brentq(lambda p: self.straight(p, 1)[0] - self.reach, -0.5, 0.5)
        told = []
        while t < until:
            t, p, mode = self.phase(t, p, mode, until, told)
        return told

    def phase(self, t, p, mode, until, told):
        if mode:

            def rate(t, y):
                u, stretch, force, _ = self.straight(y[0], mode)
                return [(self.pull(t, u) - force) / (self.drag * stretch)]

            def event(t, y):
                back = mode * rate(t, y)[0] < 0
                return (
                    (self.straight(y[0], mode)[3] - self.guard * self.critical)
                    if back
                    else -1.0
                )

            events, start = [event], [p]
        else:
            low = HEIGHT - self.height(p)[0]
            across = math.sqrt(LENGTH**2 - low**2)
            side = self.side

            def rate(t, y):
                return [(self.pull(t, y[0]) - self.bent(y[0] - p, low)) / self.drag]

            def event(t, y):
                return (y[0] - p) * side + across

            events, start = [event], [p + side * across]
        for one in events:
            one.terminal = True
        found = integrate.solve_ivp(
            rate,
            (t, until),
            start,
            "LSODA",
            events=events,
            rtol=1e-9,
            atol=1e-11,
            max_step=2e-3,
        )
        for time, y in zip(found.t, found.y[0], strict=True):
            u = self.straight(y, mode)[0] if mode else y
            told.append((time, u, mode))
        t, last = float(found.t[-1]), float(found.y[0, -1])
        if found.status == 0:
            return until, p, mode
        if mode:
            self.side = mode
            return t, last, 0
        return t, p, -self.side
