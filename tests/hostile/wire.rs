//! What travels between islands as bytes, field by field: the headers are not ours to cast.

use islands::creature::Gene;
use islands::creature::encodings::course::PARAMETER_COUNT;
use islands::transport::wire::{BatchHeader, IndividualHeader, ReportHeader, WireGene};

/// The outbox that these bytes say: a header, and genes as long as there are more.
pub fn batch(data: &[u8]) -> (BatchHeader, Vec<WireGene<Gene>>) {
    let mut fields = Fields::Read(data);
    let mut header = BatchHeader::default();
    batch_fields(&mut header, &mut fields);
    (header, genes(fields))
}

/// The report that these bytes say.
pub fn report(data: &[u8]) -> (ReportHeader, Vec<WireGene<Gene>>) {
    let mut fields = Fields::Read(data);
    let mut header = ReportHeader::default();
    report_fields(&mut header, &mut fields);
    (header, genes(fields))
}

/// The bytes that say this outbox.
pub fn batch_bytes(mut header: BatchHeader, genes: &[Gene]) -> Vec<u8> {
    let mut fields = Fields::Written(Vec::new());
    batch_fields(&mut header, &mut fields);
    bytes(fields, genes)
}

/// The bytes that say this report.
pub fn report_bytes(mut header: ReportHeader, genes: &[Gene]) -> Vec<u8> {
    let mut fields = Fields::Written(Vec::new());
    report_fields(&mut header, &mut fields);
    bytes(fields, genes)
}

/// Fields that are filled from bytes, zero when there are no more, or that bytes are made of.
enum Fields<'a> {
    Read(&'a [u8]),
    Written(Vec<u8>),
}

impl Fields<'_> {
    fn bytes<const N: usize>(&mut self, field: &mut [u8; N]) {
        match self {
            Fields::Written(bytes) => bytes.extend(*field),
            Fields::Read(bytes) => {
                let (taken, rest) = bytes.split_at(N.min(bytes.len()));
                *field = [0; N];
                field[..taken.len()].copy_from_slice(taken);
                *bytes = rest;
            }
        }
    }

    fn u32(&mut self, field: &mut u32) {
        let mut bytes = field.to_le_bytes();
        self.bytes(&mut bytes);
        *field = u32::from_le_bytes(bytes);
    }

    fn u64(&mut self, field: &mut u64) {
        let mut bytes = field.to_le_bytes();
        self.bytes(&mut bytes);
        *field = u64::from_le_bytes(bytes);
    }

    fn f64(&mut self, field: &mut f64) {
        let mut bits = field.to_bits();
        self.u64(&mut bits);
        *field = f64::from_bits(bits);
    }
}

fn batch_fields(header: &mut BatchHeader, fields: &mut Fields<'_>) {
    let BatchHeader { run_id, island, epoch, count, reserved, migrants } = header;
    fields.u64(run_id);
    [island, epoch, count, reserved].into_iter().for_each(|field| fields.u32(field));
    // The places of migrants that do not count stay empty: else nearly all of the bytes would be for nothing.
    let places = migrants.iter_mut().take(*count as usize);
    places.for_each(|one| individual_fields(one, fields));
}

fn report_fields(header: &mut ReportHeader, fields: &mut Fields<'_>) {
    fields.u64(&mut header.run_id);
    let ReportHeader { island, generation, immigrants, has_champion, species, .. } = header;
    for field in [island, generation, immigrants, has_champion, species] {
        fields.u32(field);
    }
    individual_fields(&mut header.champion, fields);
    let ReportHeader {
        best,
        mean,
        median,
        diversity,
        phenotype_diversity,
        spread_low,
        spread_high,
        seconds,
        ..
    } = header;
    for field in
        [best, mean, median, diversity, phenotype_diversity, spread_low, spread_high, seconds]
    {
        fields.f64(field);
    }
    header.spread_counts.iter_mut().for_each(|field| fields.u32(field));
    let ReportHeader { evaluations, reused, outcomes, .. } = header;
    [evaluations, reused].into_iter().chain(outcomes).for_each(|field| fields.u64(field));
}

fn individual_fields(header: &mut IndividualHeader, fields: &mut Fields<'_>) {
    let IndividualHeader { fitness, gene_count, id, parents, origin, reserved } = header;
    fields.f64(fitness);
    fields.u32(gene_count);
    id.iter_mut().chain(parents.as_flattened_mut()).for_each(|field| fields.u32(field));
    fields.u32(origin);
    fields.u32(reserved);
}

fn genes(mut fields: Fields<'_>) -> Vec<WireGene<Gene>> {
    let mut genes = Vec::new();
    while matches!(fields, Fields::Read([_, ..])) {
        let mut gene = [0.0; PARAMETER_COUNT];
        gene.iter_mut().for_each(|value| fields.f64(value));
        genes.push(WireGene(Gene(gene)));
    }
    genes
}

fn bytes(mut fields: Fields<'_>, genes: &[Gene]) -> Vec<u8> {
    genes.iter().flat_map(|gene| gene.0).for_each(|mut value| fields.f64(&mut value));
    match fields {
        Fields::Written(bytes) => bytes,
        Fields::Read(_) => unreachable!("they are written"),
    }
}
