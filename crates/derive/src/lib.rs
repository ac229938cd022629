//! The derive macro of `base::hashed::Hashed`.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{
    Attribute, Data, DeriveInput, Error, Field, Fields, Ident, Result, parse_macro_input,
    parse_quote,
};

/// Implements `base::hashed::Hashed`: the hash covers each field in its order, except those with
/// `#[hashed(skip)]`, and of an enum the number of the variant first.
#[proc_macro_derive(Hashed, attributes(hashed))]
pub fn hashed(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    implementation(input)
        .unwrap_or_else(Error::into_compile_error)
        .into()
}

fn implementation(mut input: DeriveInput) -> Result<TokenStream> {
    refuse(&input.attrs)?;
    for parameter in input.generics.type_params_mut() {
        parameter.bounds.push(parse_quote!(::base::hashed::Hashed));
    }
    let arms = arms(&input.data)?;
    let name = &input.ident;
    let (parameters, arguments, bounds) = input.generics.split_for_impl();
    Ok(quote! {
        impl #parameters ::base::hashed::Hashed for #name #arguments #bounds {
            #[inline]
            fn add_to(&self, hash: &mut ::base::hash::Hash) {
                match self { #arms }
            }
        }
    })
}

/// The arms of a `match` over the value.
fn arms(data: &Data) -> Result<TokenStream> {
    match data {
        Data::Struct(data) => arm(&quote!(Self), &data.fields, &TokenStream::new()),
        Data::Enum(data) => {
            let variants = (0_u64..).zip(&data.variants).map(|(number, variant)| {
                refuse(&variant.attrs)?;
                let name = &variant.ident;
                arm(
                    &quote!(Self::#name),
                    &variant.fields,
                    &quote!(hash.add(#number);),
                )
            });
            variants.collect()
        }
        Data::Union(data) => Err(Error::new_spanned(data.union_token, "must not be a union")),
    }
}

/// The arm of a struct or variant, which begins by `first`.
fn arm(path: &TokenStream, fields: &Fields, first: &TokenStream) -> Result<TokenStream> {
    let (mut patterns, mut added) = (Vec::new(), Vec::new());
    for (member, (number, field)) in fields.members().zip(fields.iter().enumerate()) {
        let name = format_ident!("field_{number}");
        if is_skipped(field)? {
            patterns.push(quote!(#member: _));
        } else {
            patterns.push(quote!(#member: #name));
            added.push(quote!(::base::hashed::Hashed::add_to(#name, hash);));
        }
    }
    Ok(quote!(#path { #(#patterns),* } => { #first #(#added)* }))
}

/// Whether a field has `#[hashed(skip)]`.
fn is_skipped(field: &Field) -> Result<bool> {
    let mut own = field
        .attrs
        .iter()
        .filter(|each| each.path().is_ident("hashed"));
    own.try_fold(false, |_, attribute| {
        let option: Ident = attribute.parse_args()?;
        if option == "skip" {
            return Ok(true);
        }
        Err(Error::new_spanned(option, "must be `skip`"))
    })
}

/// Refuses the attribute where it has no meaning.
fn refuse(attributes: &[Attribute]) -> Result<()> {
    let mut own = attributes
        .iter()
        .filter(|each| each.path().is_ident("hashed"));
    let error = own
        .next()
        .map(|each| Error::new_spanned(each, "only fields have this attribute"));
    error.map_or(Ok(()), Err)
}
