//! Headers of objects: groups with their members, arrays with their shape, kind and place.

use super::source::{Hdf5Bytes, Hdf5Error, HeaderBytes};
use crate::files::NumberKind;
use std::io::{Read, Seek};

/// Most objects that are looked at.
pub(super) const MAX_OBJECTS: usize = 1 << 14;
/// Most bytes of one part of a header.
const MAX_PART_BYTES: u64 = 1 << 20;
/// Most parts of a header.
const MAX_HEADER_PARTS: usize = 256;
/// Most axes of an array.
const MAX_AXES: usize = 32;

/// A filter that a chunk's bytes passed through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ChunkFilter {
    Deflate,
    /// First bytes of all numbers, then the second ones.
    Shuffle,
    /// A sum behind the bytes, which is not compared.
    Sum,
    Unread,
}

/// The type of an array's numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Member {
    pub bytes: usize,
    /// Offset and type of the number; of a compound those of real and imaginary part.
    pub parts: Vec<(usize, NumberKind)>,
}

/// Storage of an array's numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Storage {
    /// In the array's header.
    Here(Vec<u8>),
    /// In one piece; `None` where nothing was written.
    Whole(Option<u64>),
    /// In chunks of this shape, which a tree lists.
    Chunks { tree: Option<u64>, shape: Vec<usize> },
    /// In a way that is not read, by its name.
    Unread(&'static str),
}

/// A group or an array.
#[derive(Debug, Clone, Default)]
pub(super) struct Hdf5Object {
    pub shape: Vec<usize>,
    /// Type of the numbers; `None` for a type that is not read.
    pub number: Option<Member>,
    pub place: Option<Storage>,
    pub filters: Vec<ChunkFilter>,
    /// Members of a group, by name and address.
    pub children: Vec<(String, u64)>,
}

impl<R: Read + Seek> Hdf5Bytes<R> {
    /// The object whose header stands at `address`.
    pub(super) fn object(&mut self, address: u64) -> Result<Hdf5Object, Hdf5Error> {
        let start = self.up_to(address, 64)?;
        let mut object = Hdf5Object::default();
        // Blocks of messages: where each begins, and how long it is.
        let (is_new, marks_order, first) = if start.starts_with(b"OHDR") {
            let mut part = HeaderBytes::new(&start[4..]);
            part.skip(1)?;
            let flags = part.byte()?;
            part.skip(16 * usize::from(flags & 0x20 != 0) + 4 * usize::from(flags & 0x10 != 0))?;
            let length = part.number(1 << (flags & 3))?;
            (true, flags & 4 != 0, (address + (start.len() - part.rest.len()) as u64, length))
        } else {
            let mut part = HeaderBytes::new(&start);
            part.skip(8)?;
            let length = part.word()? as u64;
            (false, false, (address + 16, length))
        };
        let mut blocks = vec![first];
        let mut next = 0;
        while let Some((at, length)) = blocks.get(next).copied() {
            next += 1;
            if length > MAX_PART_BYTES || next > MAX_HEADER_PARTS {
                return Err(Hdf5Error::Damaged("a header is too long"));
            }
            let block = self.at(at, length)?;
            let mut part = HeaderBytes::new(&block);
            // A new header's block behind the first begins with its signature and ends with a sum.
            if is_new && next > 1 {
                part.skip(4)?;
                part.rest = &part.rest[..part.rest.len().saturating_sub(4)];
            }
            let least = if is_new { 4 + 2 * usize::from(marks_order) } else { 8 };
            while part.rest.len() >= least {
                let kind = if is_new { part.byte()?.into() } else { part.half()? };
                let size = part.half()?;
                let flags = part.byte()?;
                part.skip(if !is_new { 3 } else { usize::from(marks_order) * 2 })?;
                let mut message = HeaderBytes::new(part.take(size)?);
                match kind {
                    0x10 => blocks.push((message.number(self.offset_bytes)?, message.number(self.length_bytes)?)),
                    _ => self.message(kind, flags, message, &mut object)?,
                }
            }
        }
        Ok(object)
    }

    fn message(
        &mut self,
        kind: usize,
        flags: u8,
        mut message: HeaderBytes<'_>,
        object: &mut Hdf5Object,
    ) -> Result<(), Hdf5Error> {
        match kind {
            0x01 => object.shape = self.shape(message)?,
            // A type that several arrays share stands elsewhere.
            0x03 if flags & 2 == 0 => object.number = number(&mut message)?,
            0x02 => {
                message.skip(1)?;
                let flags = message.byte()?;
                message.skip(8 * usize::from(flags & 1 != 0))?;
                if self.address(&mut message)?.is_some() {
                    return Err(Hdf5Error::Unread("a group whose members stand in a heap (libver \"latest\")"));
                }
            }
            0x06 => object.children.extend(self.link(message)?),
            0x08 => object.place = Some(self.place(message)?),
            0x0b => object.filters = filters(message)?,
            0x11 => {
                let [tree, heap] = [message.number(self.offset_bytes)?, message.number(self.offset_bytes)?];
                object.children.extend(self.members(tree, heap)?);
            }
            _ => {}
        }
        Ok(())
    }

    fn shape(&self, mut message: HeaderBytes<'_>) -> Result<Vec<usize>, Hdf5Error> {
        let version = message.byte()?;
        let axes = usize::from(message.byte()?);
        message.skip(if version == 1 { 6 } else { 2 })?;
        if axes > MAX_AXES {
            return Err(Hdf5Error::Damaged("an array has too many axes"));
        }
        (0..axes).map(|_| Ok(message.number(self.length_bytes)? as usize)).collect()
    }

    /// An address; `None` for the value that means none.
    fn address(&self, message: &mut HeaderBytes<'_>) -> Result<Option<u64>, Hdf5Error> {
        let bits = 8 * self.offset_bytes as u32;
        let none = u64::MAX >> (64 - bits);
        Ok(Some(message.number(self.offset_bytes)?).filter(|address| *address != none))
    }

    fn place(&self, mut message: HeaderBytes<'_>) -> Result<Storage, Hdf5Error> {
        let (version, class) = (message.byte()?, message.byte()?);
        Ok(match (version, class) {
            (3 | 4, 0) => {
                let size = message.half()?;
                Storage::Here(message.take(size)?.to_vec())
            }
            (3 | 4, 1) => Storage::Whole(self.address(&mut message)?),
            (3, 2) => {
                // The last length is that of a number.
                let axes = usize::from(message.byte()?).saturating_sub(1);
                let tree = self.address(&mut message)?;
                let shape = (0..axes).map(|_| message.word()).collect::<Result<_, _>>()?;
                Storage::Chunks { tree, shape }
            }
            (4, 2) => Storage::Unread("an array in chunks of HDF5's version 1.10 and later (libver \"latest\")"),
            _ => Storage::Unread("an array of a very old or a virtual layout"),
        })
    }

    /// A member of a group, where it is no link to another place.
    fn link(&self, mut message: HeaderBytes<'_>) -> Result<Option<(String, u64)>, Hdf5Error> {
        message.skip(1)?;
        let flags = message.byte()?;
        let is_hard = flags & 8 == 0 || message.byte()? == 0;
        message.skip(8 * usize::from(flags & 4 != 0) + usize::from(flags & 16 != 0))?;
        let length = message.number(1 << (flags & 3))? as usize;
        let name = String::from_utf8_lossy(message.take(length)?).into_owned();
        if is_hard { Ok(Some((name, message.number(self.offset_bytes)?))) } else { Ok(None) }
    }

    /// The members that a tree lists, whose names stand in a heap.
    fn members(&mut self, tree: u64, heap: u64) -> Result<Vec<(String, u64)>, Hdf5Error> {
        let (offset, length) = (self.offset_bytes, self.length_bytes);
        let head = self.at(heap, (8 + 2 * length + offset) as u64)?;
        let mut part = HeaderBytes::new(&head[8..]);
        let size = part.number(length)?;
        part.skip(length)?;
        let place = part.number(offset)?;
        if size > MAX_PART_BYTES {
            return Err(Hdf5Error::Damaged("the names of a group are too long"));
        }
        let names = self.at(place, size)?;
        let mut leaves = Vec::new();
        self.walk(tree, 0, length, &mut |_, leaf| leaves.push(leaf))?;
        let mut members = Vec::new();
        for leaf in leaves {
            let head = self.at(leaf, 8)?;
            let count = usize::from(u16::from_le_bytes([head[6], head[7]]));
            let entries = self.at(leaf + 8, (count * (2 * offset + 24)) as u64)?;
            let mut part = HeaderBytes::new(&entries);
            for _ in 0..count {
                let (name, address) = (part.number(offset)? as usize, part.number(offset)?);
                part.skip(24)?;
                let name = names.get(name..).ok_or(Hdf5Error::Damaged("a member of a group has no name"))?;
                members.push((HeaderBytes::new(name).text()?, address));
            }
            if members.len() > MAX_OBJECTS {
                return Err(Hdf5Error::Damaged("a group has too many members"));
            }
        }
        Ok(members)
    }

    /// Calls `leaf` with the key before each leaf of a tree, and the leaf.
    pub(super) fn walk(
        &mut self,
        tree: u64,
        kind: u8,
        key_bytes: usize,
        leaf: &mut dyn FnMut(&[u8], u64),
    ) -> Result<(), Hdf5Error> {
        let mut waiting = vec![tree];
        let mut seen = 0;
        while let Some(address) = waiting.pop() {
            let head = self.at(address, (8 + 2 * self.offset_bytes) as u64)?;
            if !head.starts_with(b"TREE") || head[4] != kind || seen > MAX_OBJECTS {
                return Err(Hdf5Error::Damaged("a tree leads nowhere"));
            }
            seen += 1;
            let (level, count) = (head[5], usize::from(u16::from_le_bytes([head[6], head[7]])));
            let size = count * (key_bytes + self.offset_bytes);
            let entries = self.at(address + head.len() as u64, size as u64)?;
            let mut part = HeaderBytes::new(&entries);
            for _ in 0..count {
                let (key, child) = (part.take(key_bytes)?, part.number(self.offset_bytes)?);
                if level == 0 { leaf(key, child) } else { waiting.push(child) }
            }
        }
        Ok(())
    }
}

/// The type of an array's numbers; `None` where they are not numbers.
fn number(message: &mut HeaderBytes<'_>) -> Result<Option<Member>, Hdf5Error> {
    let (version, class, bits, bytes) = kind_head(message)?;
    if class != 6 {
        let one = kind(class, bits, bytes, message)?;
        return Ok(one.map(|kind| Member { bytes, parts: vec![(0, kind)] }));
    }
    if bits & 0xffff != 2 || !(1..=16).contains(&bytes) {
        return Ok(None);
    }
    let mut parts = Vec::new();
    for _ in 0..2 {
        let before = message.rest.len();
        let name = message.text()?;
        if version < 3 {
            // Names fill multiples of 8 bytes.
            message.skip((8 - (before - message.rest.len()) % 8) % 8)?;
        }
        let at = if version < 3 { message.word()? } else { message.number(1)? as usize };
        message.skip(if version == 1 { 28 } else { 0 })?;
        let (_, class, bits, part_bytes) = kind_head(message)?;
        let Some(kind) = kind(class, bits, part_bytes, message)? else { return Ok(None) };
        if at > bytes || kind.bytes > bytes - at {
            return Err(Hdf5Error::Damaged("a part of a complex number lies beyond it"));
        }
        parts.push((name, (at, kind)));
    }
    parts.sort_by_key(|(name, _)| name.to_ascii_lowercase().starts_with('i') || name.eq_ignore_ascii_case("q"));
    Ok(Some(Member { bytes, parts: parts.into_iter().map(|(_, part)| part).collect() }))
}

fn kind_head(message: &mut HeaderBytes<'_>) -> Result<(u8, u8, u64, usize), Hdf5Error> {
    let head = message.byte()?;
    let bits = message.number(3)?;
    Ok((head >> 4, head & 15, bits, message.word()?))
}

/// The type of one number. Its further properties are skipped.
fn kind(class: u8, bits: u64, bytes: usize, message: &mut HeaderBytes<'_>) -> Result<Option<NumberKind>, Hdf5Error> {
    let (is_float, properties) = match class {
        0 => (false, 4),
        1 => (true, 12),
        _ => return Ok(None),
    };
    message.skip(properties)?;
    let is_known = if is_float { [2, 4, 8].contains(&bytes) } else { [1, 2, 4, 8].contains(&bytes) };
    let kind = NumberKind { bytes, is_float, is_signed: bits & 8 != 0, is_big: bits & 1 != 0 };
    Ok(Some(kind).filter(|_| is_known))
}

fn filters(mut message: HeaderBytes<'_>) -> Result<Vec<ChunkFilter>, Hdf5Error> {
    let (version, count) = (message.byte()?, message.byte()?);
    message.skip(if version == 1 { 6 } else { 0 })?;
    let mut all = Vec::new();
    for _ in 0..count {
        let id = message.half()?;
        let length = if version == 1 || id >= 256 { message.half()? } else { 0 };
        message.skip(2)?;
        let values = message.half()?;
        message.skip(if version == 1 { length.next_multiple_of(8) } else { length })?;
        message.skip(4 * (values + usize::from(version == 1 && values % 2 == 1)))?;
        all.push(match id {
            1 => ChunkFilter::Deflate,
            2 => ChunkFilter::Shuffle,
            3 => ChunkFilter::Sum,
            _ => ChunkFilter::Unread,
        });
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_compound_of_no_bytes_is_no_number() {
        // Version 1, class 6 (a compound), two members, 0 bytes.
        let message = [0x16, 2, 0, 0, 0, 0, 0, 0];
        assert!(number(&mut HeaderBytes::new(&message)).unwrap().is_none());
    }
}
