//! The places of bytes in a block of 64: a bit for each byte that is equal, and their places written down, with the vector
//! instructions that a machine has.

use pulp::{Arch, NullaryFnOnce};
#[cfg(target_arch = "x86_64")]
use pulp::{cast, x86::V4};
use wide::u8x16;

/// Bytes of a block.
pub(super) const BLOCK: usize = 64;
/// Places that are written down at once where each costs an instruction of its own: more than most blocks have.
const USUAL: usize = 16;

/// How places are found and written down.
pub(super) trait Places: Copy {
    /// A bit for each byte of a block that is equal.
    fn equal(self, block: &[u8; BLOCK], byte: u8) -> u64;

    /// Writes `first` plus the place of each bit that is set to the front of `out`; what stands behind them there is
    /// overwritten as well.
    fn write(self, bits: u64, first: u32, out: &mut [u32; BLOCK]);
}

/// What is done with either way of finding places.
pub(super) trait WithPlaces {
    fn call(self, places: impl Places);
}

/// Does it with the fastest that the machine has.
pub(super) fn with_places(work: impl WithPlaces) {
    #[cfg(target_arch = "x86_64")]
    if let Some(avx512) = V4::try_new() {
        return avx512.vectorize(Call(work, Whole(avx512)));
    }
    Arch::new().dispatch(Call(work, Quarters));
}

/// Both together, compiled for a set of instructions.
struct Call<W, P>(W, P);

impl<W: WithPlaces, P: Places> NullaryFnOnce for Call<W, P> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.call(self.1);
    }
}

/// On any machine: 16 bytes at a time, and places one by one.
#[derive(Clone, Copy)]
struct Quarters;

impl Places for Quarters {
    #[inline(always)]
    fn equal(self, block: &[u8; BLOCK], byte: u8) -> u64 {
        let wanted = u8x16::splat(byte);
        let (lanes, _) = block.as_chunks::<16>();
        let mask = |lane: usize| u64::from(u8x16::new(lanes[lane]).simd_eq(wanted).to_bitmask() as u16) << (16 * lane);
        mask(0) | mask(1) | mask(2) | mask(3)
    }

    /// Several at a time, whether there are as many or not (Langdale and Lemire 2019, doi 10.1007/s00778-019-00578-5).
    #[inline(always)]
    fn write(self, mut bits: u64, first: u32, out: &mut [u32; BLOCK]) {
        let found = bits.count_ones() as usize;
        let mut next = || {
            let bit = bits.trailing_zeros();
            bits &= bits.wrapping_sub(1);
            first + bit
        };
        let (usual, others) = out.split_at_mut(USUAL);
        usual.fill_with(&mut next);
        if found > USUAL {
            others[..found - USUAL].fill_with(next);
        }
    }
}

/// With AVX-512: all 64 bytes at once, and sixteen places at a time.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
struct Whole(V4);

#[cfg(target_arch = "x86_64")]
impl Places for Whole {
    #[inline(always)]
    fn equal(self, block: &[u8; BLOCK], byte: u8) -> u64 {
        let wanted = self.0.avx512f._mm512_set1_epi8(byte.cast_signed());
        self.0.avx512bw._mm512_cmpeq_epi8_mask(cast(*block), wanted)
    }

    #[inline(always)]
    fn write(self, bits: u64, first: u32, out: &mut [u32; BLOCK]) {
        const LANES: usize = 16;
        let simd = self.0.avx512f;
        let mut at = 0;
        for quarter in 0..BLOCK / LANES {
            let bits = (bits >> (LANES * quarter)) as u16;
            let places: [u32; LANES] = std::array::from_fn(|lane| (LANES * quarter + lane) as u32);
            let places = simd._mm512_add_epi32(cast(places), simd._mm512_set1_epi32(first.cast_signed()));
            let some: [u32; LANES] = cast(simd._mm512_maskz_compress_epi32(bits, places));
            out[at..at + LANES].copy_from_slice(&some);
            at += bits.count_ones() as usize;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    struct Written<'o>([u8; BLOCK], &'o mut Vec<u32>);

    impl WithPlaces for Written<'_> {
        fn call(self, places: impl Places) {
            let bits = places.equal(&self.0, b',');
            let mut out = [u32::MAX; BLOCK];
            places.write(bits, 7, &mut out);
            self.1.extend_from_slice(&out[..bits.count_ones() as usize]);
        }
    }

    proptest! {
        #[test]
        fn prop_places_are_those_of_the_bytes(bytes in prop::collection::vec(prop_oneof![Just(b','), any::<u8>()], BLOCK)) {
            let block: [u8; BLOCK] = bytes.try_into().unwrap();
            let expected: Vec<u32> = (7..).zip(block).filter(|(_, byte)| *byte == b',').map(|(place, _)| place).collect();
            let (mut fastest, mut anywhere) = (Vec::new(), Vec::new());
            with_places(Written(block, &mut fastest));
            Call(Written(block, &mut anywhere), Quarters).call();
            prop_assert_eq!(&fastest, &expected);
            prop_assert_eq!(&anywhere, &expected);
        }
    }
}
