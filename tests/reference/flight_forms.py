"""Two formulations of flight and impact, for flights.py, beside those of contact in slip_forms.py.

vectors   three-dimensional, in the laboratory frame. The flight is a power series in time of centre, axis,
          material vector and angular velocity, and so are the heights of both rims, whose first zero is the
          landing. In an impact the velocity of the contact point answers an impulse P with P + (I^-1 (r x
          P)) x r, whatever that matrix may be.
closed    the parabola, the precession about the angular momentum, and phi and psi by Napier's analogies;
          landings by halving intervals, with a bound from above for the second derivative of the height.
          Impacts in the frame of the lean, where the inverse inertia is a_h, a_2, a_n and b: the direction
          of a slip by the angle from the lean, and all that follows the first stop in closed form.

Both share the laws: friction along an impact is that of the contact, with the normal impulse for time
(Routh, Dynamics of a System of Rigid Bodies, 1905; Keller, J. Appl. Mech. 53, 1 (1986)), and restitution is
energetic (Stronge, Proc. R. Soc. A 431, 169 (1990)): compression ends at u_n = 0 with the work W_c, the
impact where the work is (1 - e^2) W_c. On a rolling table the slip is stopped before the normal impulse
begins. The first slip runs in nu, dp = |u| dnu.
"""

import gmpy2
from gmpy2 import mpfr
from phases import first_event, step_size
from series import root

# of series in an impact: relative to the normal velocity
FINE, ORDER, STOPPED = mpfr("1e-42"), 36, mpfr("1e-44")


class Air(list):
    """The numbers of a state in the air: those of a contact, and of the height where they are apart."""

    def __init__(self, y, lift=None, height=None):
        super().__init__(y)
        self.lift, self.height = lift, height


class Bounce:
    """An impact: the state after it, the impulse along h, e2, z, what the contact did, the energy lost."""

    def __init__(self, y, lift, impulse, kind, lost):
        self.y, self.lift, self.impulse, self.kind, self.lost = y, lift, impulse, kind, lost


class Below:
    """Less a series: its changes of sign are events as it grows through a level."""

    def __init__(self, node, level=0):
        self.node, self.level = node, level

    def at(self, h):
        return self.level - self.node.at(h)


class Watched:
    """What `step_size` asks of a phase."""

    slip = ()

    def __init__(self, tape, *more):
        self.tape = type("", (), {"states": [*tape.states, *more]})


def ended(lift, work, pressed, most, rate, e):
    """How far a straight piece of an impact goes: normal impulse, velocity, work, and whether it ends there.

    The normal velocity grows at this rate, for at most this impulse; `pressed` is the work of the
    compression, if that has ended.
    """
    if pressed is None and rate > 0 and -lift / rate <= most:
        pressed = work - lift * lift / (2 * rate)
    far, done = most, False
    if pressed is not None:
        if lift < 0 or e > 0:
            left = lift * lift + 2 * rate * ((1 - e * e) * pressed - work)
            far = (-lift + gmpy2.sqrt(max(left, mpfr(0)))) / rate
        else:
            far = mpfr(0)
        done = far <= most
        far = min(far, most)
    return far, lift + rate * far, work + lift * far + rate * far * far / 2, pressed, done


def slid(tape, stop, e, size, lift, work, start):
    """The first slip of an impact, by the series of its equations.

    True if the impact ends as it slips; the states there; the work of a compression that is over.
    """
    pressed = None
    watched = Watched(tape, size)
    watched.slip, watched.size = stop, size
    for _ in range(4000):
        tape.expand(start, ORDER)
        h = step_size(watched, ORDER, FINE)
        h = min(h, 8 * (abs(lift.c[0]) + abs(work.c[0]) + mpfr("1e-6")) / abs(lift.c[1]))
        events = [("pressed", Below(lift))]
        if pressed is not None:
            events = [("ends", Below(work, (1 - e * e) * pressed))]
        place, name = first_event(events, h)
        h = h if name is None else place
        start = [node.at(h) for node in tape.states]
        if name == "pressed":
            pressed = work.at(h)
        if name == "ends" or (name == "pressed" and e == 0):
            return True, start, pressed
        if size.at(h) < STOPPED:
            return False, start, pressed
    raise ArithmeticError("an impact without end")


def landing(height, end, most, order):
    """The first time up to `end` at which a height is 0; infinite if there is none.

    The height and its rate are given, and the largest of its second derivative. `order` is that of the height
    if it is 0 at the start.
    """
    most = max(most, mpfr("1e-9"))
    t = mpfr(0)
    if order:
        t = end * mpfr("1e-9")
        if order == 1:
            t = min(t, height(mpfr(0))[1] * mpfr("1e-3"))
        while order > 1 and t < end / 50 and all(height(t * k / 8)[0] > 0 for k in range(1, 17)):
            t *= 2
    (low, _), todo = height(t), [end]
    assert low > 0, "a flight that does not rise"
    while todo:
        x = todo[-1]
        high, width = height(x)[0], x - t
        if high > 0:
            v = (low - high) / (most * width)
            least = min(low, high)
            if abs(v) < width / 2:
                least = (low + high) / 2 - most * (width * width / 8 + v * v / 2)
            if least > 0:
                t, low = x, high
                todo.pop()
                continue
        elif height(t)[1] + most * width < 0:
            node = type("", (), {"at": staticmethod(lambda x: height(x)[0])})
            return root(node, t, x)
        assert width > end * mpfr("1e-24"), "a rim that grazes the table"
        todo.append(t + width / 2)
    return mpfr("inf")
