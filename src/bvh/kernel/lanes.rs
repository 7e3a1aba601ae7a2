//! Eight f32 lanes as a plain array, for every target.

/// Eight lanes.
#[derive(Clone, Copy)]
pub(super) struct Lanes([f32; 8]);

macro_rules! lanewise {
    ($($name:ident: $op:expr;)*) => {$(
        #[inline(always)]
        pub(super) fn $name(self, other: Self) -> Self {
            let op: fn(f32, f32) -> f32 = $op;
            Self(std::array::from_fn(|i| op(self.0[i], other.0[i])))
        }
    )*};
}

macro_rules! compare {
    ($($name:ident: $op:tt;)*) => {$(
        #[inline(always)]
        pub(super) fn $name(self, other: Self) -> u32 {
            (0..8).fold(0, |mask, i| mask | u32::from(self.0[i] $op other.0[i]) << i)
        }
    )*};
}

impl Lanes {
    #[inline(always)]
    pub(super) fn splat(x: f32) -> Self {
        Self([x; 8])
    }

    #[inline(always)]
    pub(super) fn load(from: &[f32; 8]) -> Self {
        Self(*from)
    }

    #[inline(always)]
    pub(super) fn to_array(self) -> [f32; 8] {
        self.0
    }

    #[inline(always)]
    pub(super) fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }

    lanewise! {
        add: |a, b| a + b;
        sub: |a, b| a - b;
        mul: |a, b| a * b;
        div: |a, b| a / b;
        // The second operand where either is NaN, as the x86 instructions.
        min: |a, b| if a < b { a } else { b };
        max: |a, b| if a > b { a } else { b };
    }

    // Bit i: the comparison holds in lane i.
    compare! {
        lt: <;
        le: <=;
        eq: ==;
    }
}
